"""The pages of this repository."""
import os
import re

import pytest
from pages import blocks, links, markdown

ROOT = os.path.realpath(os.path.join(os.path.dirname(__file__), '..', '..', '..'))
EXAMPLES = {'extras/create/test_identification.py', 'rows/sigkill.py'}     # relative to other folders


def test_links():
    """None is broken, README.md leads to every page in docs/, and every picture is shown."""
    assert links.problems(ROOT) == []


@pytest.mark.parametrize('page', markdown.documents(ROOT))
def test_blocks(page):
    """Each has a comment that says how it is checked."""
    blocks.parse(markdown.read(ROOT, page))


@pytest.mark.parametrize('page', [page for page in markdown.files(ROOT, '.md')
                                  if page.startswith(('CONTRIBUTING', 'docs/decisions/'))])
def test_a_module_that_a_page_for_maintainers_names_exists(page):
    names = re.findall(r'`((?:[a-z_]+/)+[a-z_]+\.(?:py|js|css|launch))`', markdown.read(ROOT, page))
    places = [ROOT, os.path.join(ROOT, 'src', 'rbx1_nav')]
    names = [name for name in names if name not in EXAMPLES]
    assert [name for name in names if not any(os.path.exists(os.path.join(place, name)) for place in places)] == []
