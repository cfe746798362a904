"""The pages of this repository."""
import os

import pytest
from pages import blocks, links, markdown

ROOT = os.path.realpath(os.path.join(os.path.dirname(__file__), '..', '..', '..'))


def test_links():
    """None is broken, README.md leads to every page in docs/, and every picture is shown."""
    assert links.problems(ROOT) == []


@pytest.mark.parametrize('page', markdown.documents(ROOT))
def test_blocks(page):
    """Each has a comment that says how it is checked."""
    blocks.parse(markdown.read(ROOT, page))


def test_readme_runs():
    """README.md has commands that are run."""
    steps = blocks.parse(markdown.read(ROOT, 'README.md'))
    assert any(isinstance(each, blocks.Start) for each in steps) and any(isinstance(each, blocks.Run) for each in steps)
