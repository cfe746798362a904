// The words of the page in the language of the browser, or of ?lang= in its address.

import {WORDS as ENGLISH} from './words_en.js';
import {WORDS as SIMPLIFIED} from './words_zh.js';
import {WORDS as TRADITIONAL} from './words_zh_tw.js';

const LANGUAGES = [['zh-TW', /^zh-(TW|HK|MO|Hant)/i, TRADITIONAL], ['zh-CN', /^zh/i, SIMPLIFIED], ['en', /^en/i, ENGLISH]];
const wanted = [new URLSearchParams(location.search).get('lang') || '', ...navigator.languages, 'en'];
export const [LANGUAGE, , WORDS] = wanted.map(name => LANGUAGES.find(([, pattern]) => pattern.test(name))).find(Boolean);

// Writes the words into the elements of index.html.
export function fill() {
  document.documentElement.lang = LANGUAGE;
  for (const [key, write] of Object.entries({
    text: (element, word) => { element.textContent = word; },
    label: (element, word) => element.setAttribute('aria-label', word),
    title: (element, word) => { element.title = word; }})) {
    document.querySelectorAll(`[data-${key}]`).forEach(element => write(element, WORDS[element.dataset[key]]));
  }
}
