"""Links from outside keep working: each anchor that a page in docs/ had is still there."""
import os

import pytest
from pages import links, markdown

FOLDER = os.path.dirname(__file__)
ROOT = os.path.realpath(os.path.join(FOLDER, '..', '..', '..'))
# page: its anchors before pages were merged
OLD = dict(line.split(': ') for line in markdown.read(FOLDER, 'old_anchors.txt').splitlines())


@pytest.mark.parametrize('page', OLD)
def test_each_old_anchor_exists(page):
    assert set(OLD[page].split(', ')) - links.anchors(markdown.read(ROOT, page)) == set()
