#!/usr/bin/python3
"""Follows README.md and docs/*.md as a reader would: types their commands and compares the output.

    documents.py [NAME...] [--text]     only the pages whose name contains a NAME; --text prints the result

test/pages/blocks.py describes the comments that control how. Source a built workspace first.
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
from ports import own_loopback

ROOT = os.path.realpath(os.path.join(os.path.dirname(__file__), '..'))
PARALLEL = 4    # pages that are followed at the same time


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
    """Make ~/catkin_ws: only the sources if the steps run catkin_make, otherwise the sourced workspace."""
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
    own_loopback()
    with tempfile.TemporaryDirectory() as home, virtual_display() as display:
        make_workspace(home, steps)
        with Session(page, home, display) as session:
            if not typed(steps, blocks.Setup):
                session.setup = typed(read_steps('README.md'), blocks.Setup)
            session.follow(steps)


class Documents(unittest.TestCase):
    """One test per page. A page without steps is only parsed."""

    @classmethod
    def setUpClass(cls):
        # in parallel: the pages mostly wait for robots that move in real time, but with more they compete
        with ThreadPoolExecutor(1 if cls.repeated else PARALLEL) as pool:
            cls.results = {page: pool.submit(follow, page) for page in cls.pages}

    @classmethod
    def add_tests(cls, names):
        """Add tests for the pages whose name contains one of these names; without names, for all pages.

        If script/run_tests.py repeats this test, only for the pages that have failed.
        """
        # no dots or slashes: rosunit would truncate the name there
        pages = {'test_' + re.sub(r'\W+', '_', os.path.splitext(page)[0]): page for page in markdown.documents(ROOT)
                 if any(name in page for name in names or [''])}
        cls.repeated = pages.keys() & set(os.environ.get('FAILED_TESTS', '').split())
        cls.pages = [page for test, page in pages.items() if not cls.repeated or test in cls.repeated]
        for test, page in pages.items():
            if page in cls.pages:
                setattr(cls, test, lambda self, page=page: self.check(page))

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
