#!/usr/bin/python3
"""Without a terminal, a calibration script stores its run; _measured:= supplies the answer later, without driving."""
import re

import rospy
from geometry_msgs.msg import Twist

import support


class TestAnsweredLater(support.Case):
    def check(self, node, argument, keys, wrong, expected):
        """Drive without an answer, then enter an invalid result, then a valid result twice."""
        script = f'calibrate_{node}.py'
        run = support.Process('rosrun', 'rbx1_nav', script)
        run.process.stdin.close()
        self.assertEqual(run.wait(), 0, run.output)
        self.assertIn(f'rosrun rbx1_nav {script} _measured:=', run.output)
        self.assertNotIn('_correction: ', run.output)
        reported, = re.findall('The odometry reports .*', run.output)

        commands = support.Watch('/cmd_vel', Twist)
        for measured, status in [(wrong, 1), (argument, 0), (argument, 0)]:
            later = support.Process('rosrun', 'rbx1_nav', script, f'_measured:={measured}')
            self.assertEqual(later.wait(), status, later.output)
            factors = dict(re.findall(r'^(\w+_correction): (\S+)$', later.output, re.MULTILINE))
            self.assertIn(reported, later.output)
            if status:
                self.assertIn(expected, later.output)
                self.assertFalse(factors)
            else:
                # the odometry of the simulated base reports about the goal, and a sixth of the goal is missing
                self.assertEqual(sorted(factors), sorted(keys))
                self.assertAlmostEqual(float(factors[keys[0]]), 5 / 6, delta=0.005)
            self.assertFalse(rospy.has_param(f'/calibrate_{node}/measured'), 'it belongs to this run only')
        self.assertFalse(commands.messages)

    def test_linear(self):
        self.check('linear', 0.8333, ['odom_linear_scale_correction'], 83,
                   'measured: 83: expected a distance from')

    def test_angular(self):
        self.check('angular', 300, ['odom_angular_scale_correction', 'gyro_scale_correction'], 3.1,
                   'measured: 3.1: expected an angle from')


if __name__ == '__main__':
    support.main(TestAnsweredLater)
