#!/usr/bin/python3
"""Runs the scripts of several rostests one after another in one set-up. script/run_tests.py starts it.

usage: together.py NAME,SCRIPT,ARGUMENT,... ...
"""
import os
import subprocess
import sys
import unittest
from xml.etree import ElementTree

import rosgraph
import rospy
import rostest
from std_srvs.srv import Empty

LIMIT = 900     # s after which a script counts as hung, even on a busy machine
RESULT = '--gtest_output=xml:'
RESET = '/arbotix/reset'


def put_robot_back():
    """Put the simulated robot, if there is one, back at the origin, where each of the scripts expects it."""
    services = rosgraph.Master('/together').getSystemState()[2]
    if any(name == RESET for name, _ in services):
        rospy.ServiceProxy(RESET, Empty)()


class Together(unittest.TestCase):
    """One test for each script. It fails only if the script leaves no result that can be read; its results are counted
    separately."""

    @classmethod
    def add_test(cls, results, name, *command):
        """Add a test. results: folder of the results; name: of the rostest; command: path of its script, arguments."""
        result = os.path.join(results, f'rosunit-{name}.xml')

        def run(self):
            put_robot_back()
            script = subprocess.run([*command, f'__name:={name}', RESULT + result], timeout=LIMIT, check=False,
                                    stdout=subprocess.PIPE, stderr=subprocess.STDOUT, universal_newlines=True)
            print(script.stdout)
            try:
                ElementTree.parse(result)
            except (FileNotFoundError, ElementTree.ParseError, LookupError) as error:
                self.fail(f'{name} left no result that can be read ({error}); status {script.returncode}, '
                          f'output:\n{script.stdout}')
        setattr(cls, f'test_{name}', run)


if __name__ == '__main__':
    own = next(each[len(RESULT):] for each in sys.argv if each.startswith(RESULT))
    for each in sys.argv[1:]:
        if ',' in each:
            Together.add_test(os.path.dirname(own), *each.split(','))
    rostest.rosrun('rbx1_nav', 'together', Together)
