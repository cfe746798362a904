#!/usr/bin/python3
"""The pictures of the running system in docs/reference.md are what script/graph.py draws of it."""
import os
import re
import sys

import rospkg

import support

PACKAGE = rospkg.RosPack().get_path('rbx1_nav')
sys.path.insert(0, os.path.join(PACKAGE, 'script'))
import graph


class TestReferenceGraph(support.Case):
    maxDiff = None

    def test_pictures(self):
        with open(os.path.join(PACKAGE, 'docs', 'reference.md'), encoding='utf-8') as page:
            expected = re.findall('```mermaid\n(.*?)\n```', page.read(), re.DOTALL)
        self.assertEqual(len(expected), 2)
        system = graph.RunningSystem()
        try:
            # nodes start one after the other
            support.wait_for(lambda: list(system.draw()) == expected, 'the pictures of docs/reference.md')
        except AssertionError:
            self.assertEqual('\n'.join(system.draw()), '\n'.join(expected),
                             '\nLines with - are in the current diagrams, lines with + are on the page')


if __name__ == '__main__':
    support.main(TestReferenceGraph)
