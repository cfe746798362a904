"""The pages in docs/zh/ follow the English pages, section by section; traditional Chinese is made from simplified."""
import os
import re
import sys

import pytest
from pages import links, markdown

ROOT = os.path.realpath(os.path.join(os.path.dirname(__file__), '..', '..', '..'))
sys.path.insert(0, os.path.join(ROOT, 'script'))

import traditional  # noqa: E402

# page: its sections that are not in the Chinese page
PAGES = {'README.md': ['documentation'], 'docs/tutorial.md': [], 'docs/the_script.md': []}
CHINESE = {page: 'docs/zh/' + os.path.basename(page) for page in PAGES}
# at the end of a Chinese heading: the anchor and the hash of the English section; not if it exists in Chinese only
FOLLOWS = re.compile(r' <a id="(?P<anchor>[\w-]+)"></a><!-- (?P<hash>\w+) -->$')
NUMBER = re.compile(r'\b(\d+(?:\.\d+)*)(?: ?(m/s|[mc]?m|m?s|rad(?:/s)?|Hz|MB|GB|%|degrees|度)(?!\w))?', re.ASCII)


def sections(page):
    """{heading: (lines of prose without comments, blocks of code)} of a page."""
    found, prose, code = {}, [], []
    for _, language, lines in markdown.split(markdown.read(ROOT, page)):
        if language is not None:
            code.append((language, *lines))
        elif links.HEADING.match(lines[0]):
            prose, code = found[lines[0]] = [FOLLOWS.sub('', lines[0])], []
        elif not lines[0].startswith('<'):
            prose += lines
    return found


def contents(page, prose, code):
    """{kind: set} of what is the same in both languages."""
    text, found = ' '.join(prose), set()
    for _, target, _ in links.targets(text):
        path, _, anchor = target.partition('#')
        path = os.path.normpath(os.path.join(os.path.dirname(page), path)) if path else page
        if path != 'docs/zh/glossary.md':   # it exists in Chinese only
            found.add((CHINESE.get(path, path).replace('/zh_TW/', '/zh/'), anchor))
    return {'links': found, 'code blocks': set(code), 'code': {each[0] for each in markdown.CODE_SPAN.finditer(text)},
            'numbers': {number + each for number, unit in NUMBER.findall(text)
                        for each in ('', unit.replace('度', 'degrees'))}}


@pytest.mark.parametrize('page', PAGES)
def test_the_chinese_page_follows_the_english_one(page):
    english = {links.slug(heading.strip('# ')): section for heading, section in sections(page).items()}
    chinese = {FOLLOWS.search(heading): section for heading, section in sections(CHINESE[page]).items()}
    chinese.pop(None, None)
    assert [each['anchor'] for each in chinese] == [name for name in english if name not in PAGES[page]]
    wrong = []
    for (name, old), section in ((each.groups(), section) for each, section in chinese.items()):
        first, second = contents(page, *english[name]), contents(CHINESE[page], *section)
        wrong += [f'{name}: {kind}: in English {first[kind] - second[kind]}, in Chinese {second[kind] - first[kind]}'
                  for kind in first if first[kind] != second[kind]]
        prose, code = english[name]
        new = traditional.digest(' '.join(prose) + str(code))
        if old != new:
            wrong.append(f'{name}: the English section has changed. When the Chinese one follows it, run: '
                         f'sed -i s/{old}/{new}/ {CHINESE[page]}')
    assert not wrong, '\n'.join(wrong)


@pytest.mark.parametrize('source', sorted(traditional.FILES))
def test_the_traditional_text_is_up_to_date(source):
    simplified, text = (markdown.read(ROOT, path) for path in (source, traditional.FILES[source]))
    converted, _, _ = text.rstrip('\n').rpartition('\n')
    assert traditional.marked(simplified, converted) == text, 'run script/traditional.py'
