"""A file that a page for developers or a docstring names exists."""
import os
import re

import pytest
from pages import markdown

ROOT = os.path.realpath(os.path.join(os.path.dirname(__file__), '..', '..', '..'))
NAME = re.compile(r'(?<![\w.*/{$~-])((?:[\w-]+/)*[\w-]+\.(?:py|md|launch|test|yaml|js))\b')
PAGES = ['CONTRIBUTING.md', *sorted(f'docs/decisions/{name}' for name in os.listdir(
    os.path.join(ROOT, 'docs', 'decisions')))]


def existing():
    """The paths of all files, and each end of such a path."""
    found = set()
    for folder, folders, names in os.walk(ROOT, followlinks=True):     # bench/mutations.py copies links
        folders[:] = [name for name in folders if not name.startswith('.')]
        for name in names:
            parts = os.path.relpath(os.path.join(folder, name), ROOT).split(os.sep)
            found.update('/'.join(parts[start:]) for start in range(len(parts)))
    return found


FILES = existing()


def unknown(text):
    return sorted({name for name in NAME.findall(text) if name not in FILES and 'NAME' not in name})


@pytest.mark.parametrize('page', PAGES)
def test_a_file_that_a_page_names_exists(page):
    assert unknown(markdown.read(ROOT, page)) == []


def test_a_file_that_a_module_names_exists():
    found = {}
    for path in sorted(FILES):
        if path.startswith('src/rbx1_nav/') and path.endswith('.py'):
            missing = unknown(markdown.read(ROOT, path))
            if missing:
                found[path] = missing
    assert found == {}


def test_a_file_that_does_not_exist_is_found():
    assert unknown('see `arrays.py`, node/units.py and command_gate.py') == ['arrays.py', 'node/units.py']
