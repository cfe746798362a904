#!/usr/bin/python3
"""Follows README.md and docs/*.md as a reader does: types their commands and compares the output.

    documents.py [NAME...] [--text]     only the pages with one of these in their name; --text prints the result

test/pages/blocks.py describes the comments that say how. Source a built workspace first.
"""
import os
import re
import sys
import tempfile
import unittest
from concurrent.futures import ThreadPoolExecutor

import rostest

from pages import blocks, markdown
from pages.display import virtual_display
from pages.session import PageFailed, Session

ROOT = os.path.realpath(os.path.join(os.path.dirname(__file__), '..'))


def read_steps(page):
    """The steps of a page."""
    try:
        return blocks.parse(markdown.read(ROOT, page))
    except ValueError as error:
        raise PageFailed(f'{page}:{error}') from None


def typed(steps, kind):
    """The commands of all steps of a kind."""
    return [command for step in steps if isinstance(step, kind) for command in step.commands]


def make_workspace(home, steps):
    """Make ~/catkin_ws. Where the steps run catkin_make it contains only the sources, else it is the one sourced."""
    workspace = os.path.join(home, 'catkin_ws')
    if any('catkin_make' in command for command in typed(steps, blocks.Run)):
        os.makedirs(os.path.join(workspace, 'src'))
        os.symlink(ROOT, os.path.join(workspace, 'src', 'rbx1_nav'))
    else:
        os.symlink(os.path.dirname(os.environ['CMAKE_PREFIX_PATH'].split(':')[0]), workspace)


def follow(page):
    """Follow a page in a new home directory. Raises PageFailed."""
    steps = read_steps(page)
    if not steps:
        return
    with tempfile.TemporaryDirectory() as home, virtual_display() as display:
        make_workspace(home, steps)
        with Session(page, home, display) as session:
            if not typed(steps, blocks.Setup):
                session.setup = typed(read_steps('README.md'), blocks.Setup)
            session.follow(steps)


class Documents(unittest.TestCase):
    """A test for each page. A page without steps is only read."""

    @classmethod
    def setUpClass(cls):
        # all at once: most of the time is spent waiting for robots that move in real time
        with ThreadPoolExecutor(len(cls.pages)) as pool:
            cls.results = {page: pool.submit(follow, page) for page in cls.pages}

    @classmethod
    def add_tests(cls, names):
        """Add the tests of the pages with one of these in their name; no names: of all pages."""
        cls.pages = [page for page in markdown.documents(ROOT) if any(name in page for name in names or [''])]
        for page in cls.pages:
            # no dots or slashes: rosunit would cut the name there
            name = re.sub(r'\W+', '_', os.path.splitext(page)[0])
            setattr(cls, f'test_{name}', lambda self, page=page: self.check(page))

    def check(self, page):
        """Fail with the message of the page, without the traceback of its thread."""
        try:
            self.results[page].result()
        except PageFailed as error:
            self.fail(error)


if __name__ == '__main__':
    # rostest adds options and remappings
    Documents.add_tests([each for each in sys.argv[1:] if not each.startswith('-') and ':=' not in each])
    rostest.rosrun('rbx1_nav', 'documents', Documents)
