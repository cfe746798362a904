"""Links from outside keep working: each anchor that a page in docs/ had is still there, or leads to its new place."""
import os
import re

import pytest
from pages import links, markdown

FOLDER = os.path.dirname(__file__)
ROOT = os.path.realpath(os.path.join(FOLDER, '..', '..', '..'))
ENTRY = re.compile(r'- (<a id="[^"]+"></a>)*\[[^]]+\]\([^)]+\)')
# page: its anchors before pages were merged
OLD = dict(line.split(': ') for line in markdown.read(FOLDER, 'old_anchors.txt').splitlines())


@pytest.mark.parametrize('page', OLD)
def test_each_old_anchor_exists(page):
    assert set(OLD[page].split(', ')) - links.anchors(markdown.read(ROOT, page)) == set()


@pytest.mark.parametrize('page', [page for page in OLD if links.has_moved(markdown.read(ROOT, page))])
def test_each_anchor_of_a_page_that_has_moved_stands_beside_a_link(page):
    """test_repository.py checks where the links lead."""
    lines = markdown.read(ROOT, page).splitlines()[4:]
    assert lines and all(ENTRY.fullmatch(line) for line in lines)
