#!/usr/bin/python3
"""A system clock that is stepped by hours does not move the robot, and the stamps follow it."""
import os
import tempfile
import unittest

import rospkg
from tf2_msgs.msg import TFMessage

import support

# The node as it is, on a time of day that is this far from the real one. libfaketime would do it one level deeper, but
# Debian 12's makes Python's sleep fail.
STEPPED = """
import runpy, sys, time
real, (node, offset) = time.time, sys.argv[1:]
time.time = lambda: real() + float(open(offset).read() or 0)
time.time_ns = lambda: int(time.time() * 1e9)
sys.argv = [node]
runpy.run_path(node, run_name='__main__')
"""


class TestSystemClock(unittest.TestCase):
    def test_steps(self):
        support.init_node('system_clock')
        scratch = tempfile.NamedTemporaryFile('w', delete=False)
        self.addCleanup(os.remove, scratch.name)

        def step(offset):
            with open(scratch.name, 'w') as file:
                file.write(offset)

        step('+0')
        node = rospkg.RosPack().get_path('rbx1_nav') + '/nodes/fake_base.py'
        base = support.Process('/usr/bin/python3', '-c', STEPPED, node, scratch.name)
        self.addCleanup(base.kill)
        odom = support.OdomWatch()
        transforms = support.Watch('/tf', TFMessage)
        commander = support.Commander()
        for offset, hours in (('+7200', 2), ('-10800', -3)):
            commander.send(0.2)
            odom.wait_for_twist(0.2)
            start = odom.position()[0]
            before = odom.last.header.stamp.to_sec()
            step(offset)
            # the message after the step shows it; an hour is far more than a test takes
            support.wait_for(lambda: abs(odom.last.header.stamp.to_sec() - before) > 3600, 'a stamp that has stepped')
            self.assertEqual(odom.last.header.stamp.to_sec() > before, hours > 0)
            odom.wait_for_twist(0.0)
            # the timeout of 1.0 s ended it, and 0.2 m/s for 1.0 s is all that it moved
            self.assertLessEqual(odom.position()[0] - start, 0.2 + support.MICROMETRE)
        self.assertAlmostEqual(odom.position()[0], 0.4, delta=support.MICROMETRE)
        stamps = [t.header.stamp for m in transforms.messages for t in m.transforms]
        self.assertEqual(len(stamps), len(set(stamps)), 'no two transforms with one stamp')


if __name__ == '__main__':
    support.main('system_clock', TestSystemClock)
