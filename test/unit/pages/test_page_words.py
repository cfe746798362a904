"""All words of the page in the browser are in web/words_*.js, in each language."""
from html.parser import HTMLParser
import os
import re

WEB = os.path.join(os.path.dirname(__file__), '..', '..', '..', 'web')
# texts that are not words of the page: its name before any script runs, and what is shown without scripts
NAMES = {'Out and back', 'Seats', 'This page needs JavaScript.'}


def read(name):
    with open(os.path.join(WEB, name), encoding='utf-8') as file:
        return file.read()


class Words(HTMLParser):
    """Collects the texts of a page, and the names of the texts that it takes from words_en.js."""

    def __init__(self, text):
        super().__init__()
        self.texts, self.names = set(), set()
        self.feed(text)

    def handle_starttag(self, tag, attrs):
        values = dict(attrs)
        self.names |= {values[key] for key in ('data-text', 'data-label', 'data-title') if key in values}
        self.texts |= {values[key] for key in ('aria-label', 'title', 'placeholder') if key in values}

    def handle_data(self, data):
        if re.search('[A-Za-z]{2}', data):
            self.texts.add(data.strip())


def keys(name):
    """The names of the texts in a file of words."""
    found = re.findall(r"(?:[{,]|^)\s*(?:'([a-z ]+)'|(\w+)): ", read(name).partition('export const WORDS')[2], re.M)
    return {quoted or plain for quoted, plain in found}


def test_the_page_takes_its_words_from_one_file():
    page, words = Words(read('index.html') + read('seats.html')), keys('words_en.js')
    assert page.texts == NAMES
    assert page.names <= words, page.names - words
    scripts = [os.path.join(folder, name) for folder in ('.', os.path.join('..', 'page'))
               for name in os.listdir(os.path.join(WEB, folder)) if name.endswith('.js')]
    used = {name for each in scripts for name in re.findall(r'\bWORDS\.(\w+)', read(each))}
    assert used <= words, used - words


def test_the_chinese_words_have_the_names_of_the_english_ones():
    assert keys('words_zh.js') == keys('words_zh_tw.js') == keys('words_en.js')


def test_the_sentences_that_are_translated_are_sentences_of_the_server():
    root, files = os.path.join(WEB, '..'), [os.path.join(WEB, '..', 'launch', 'web_view.launch')]
    for folder in ('web', 'page'):
        folder = os.path.join(root, 'src', 'rbx1_nav', 'extras', folder)
        files += [os.path.join(folder, name) for name in os.listdir(folder) if name.endswith('.py')]
    sources = ''.join(map(read, files))
    sentences = re.findall(r'\[/\^(.*?)\$?/, ', read('words_zh.js'))
    assert len(sentences) > 5
    for sentence in sentences:
        for part in re.split(r'\(.*?\)', sentence):
            assert part in sources, sentence


def test_no_other_file_has_sentences():
    for name in os.listdir(WEB):
        if name.endswith('.js') and not name.startswith('words_'):
            code = re.sub(r'//.*', '', read(name))
            texts = re.findall(r"'([^'\n]*)'|`([^`]*)`", code)
            found = [each for each in map(''.join, texts) if re.match(r"[A-Z][a-z]+ [a-z]+", each)]
            assert not found, (name, found)
