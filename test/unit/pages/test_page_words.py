"""All words of the page in the browser are in web/words.js."""
from html.parser import HTMLParser
import os
import re

WEB = os.path.join(os.path.dirname(__file__), '..', '..', '..', 'web')
# texts that are not words of the page: its name before any script runs, and what is shown without scripts
NAMES = {'Out and back', 'This page needs JavaScript.'}


def read(name):
    with open(os.path.join(WEB, name), encoding='utf-8') as file:
        return file.read()


class Words(HTMLParser):
    """Collects the texts of a page, and the names of the texts that it takes from words.js."""

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


def test_the_page_takes_its_words_from_one_file():
    page, words = Words(read('index.html')), read('words.js')
    assert page.texts == NAMES
    keys = set(re.findall(r"(?:[{,]|^)\s*'?([a-zA-Z][a-zA-Z ]*?)'?: ", words, re.M))
    assert page.names <= keys, page.names - keys
    scripts = [name for name in os.listdir(WEB) if name.endswith('.js')]
    used = {name for each in scripts for name in re.findall(r'\bWORDS\.(\w+)', read(each))}
    assert used <= keys, used - keys


def test_no_other_file_has_sentences():
    for name in os.listdir(WEB):
        if name.endswith('.js') and name != 'words.js':
            code = re.sub(r'//.*', '', read(name))
            texts = re.findall(r"'([^'\n]*)'|`([^`]*)`", code)
            found = [each for each in map(''.join, texts) if re.match(r"[A-Z][a-z]+ [a-z]+", each)]
            assert not found, (name, found)
