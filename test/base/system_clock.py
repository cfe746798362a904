#!/usr/bin/python3
"""A step of the system clock by hours does not move the robot, and the stamps follow the clock."""
import os
import tempfile

import rospkg
from tf2_msgs.msg import TFMessage

import support

# The unchanged node, with a time of day that is shifted by the number in a file. libfaketime could do this without
# patching Python, but the version in Debian 12 breaks time.sleep().
STEPPED = """
import runpy, sys, time
real, (node, offset) = time.time, sys.argv[1:]
time.time = lambda: real() + float(open(offset).read() or 0)
time.time_ns = lambda: int(time.time() * 1e9)
sys.argv = [node]
runpy.run_path(node, run_name='__main__')
"""


class TestSystemClock(support.Case):
    def test_steps_forward_and_back(self):
        scratch = tempfile.NamedTemporaryFile('w', delete=False)
        self.addCleanup(os.remove, scratch.name)

        def step(offset):
            with open(scratch.name, 'w') as file:
                file.write(offset)

        step('+0')
        node = f"{rospkg.RosPack().get_path('rbx1_nav')}/nodes/fake_base.py"
        support.Process('/usr/bin/python3', '-c', STEPPED, node, scratch.name)
        odom = support.OdomWatch()
        transforms = support.Watch('/tf', TFMessage)
        commander = support.Commander()
        for offset, hours in (('+7200', 2), ('-10800', -3)):
            commander.send(0.2)
            odom.wait_for_twist(0.2)
            start = odom.position()[0]
            before = odom.last.header.stamp.to_sec()
            step(offset)
            # an hour is far more than the test takes
            support.wait_for(lambda: abs(odom.last.header.stamp.to_sec() - before) > 3600, 'a stamp that has stepped')
            self.assertEqual(odom.last.header.stamp.to_sec() > before, hours > 0)
            odom.wait_for_twist(0.0)
            # the command expired after the timeout of 1.0 s, so the base moved at 0.2 m/s for at most 1.0 s
            self.assertLessEqual(odom.position()[0] - start, 0.2 + support.MICROMETRE)
        self.assertAlmostEqual(odom.position()[0], 0.4, delta=support.MICROMETRE)
        stamps = [t.header.stamp for m in transforms.messages for t in m.transforms]
        self.assertEqual(len(stamps), len(set(stamps)), 'no two transforms with one stamp')


if __name__ == '__main__':
    support.main(TestSystemClock)
