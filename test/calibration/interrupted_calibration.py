#!/usr/bin/python3
"""A calibration script that is interrupted while driving or asking stops the robot and exits."""
import signal

import rospy
from geometry_msgs.msg import Twist

import support


class TestInterruptedCalibration(support.Case):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.odom = support.OdomWatch()

    def check(self, script, line=None):
        """Interrupt a script in motion, or after `line`."""
        commands = support.Watch('/cmd_vel', Twist)
        self.addCleanup(commands.subscriber.unregister)
        kept = f"/last_calibration/{script[len('calibrate_'):-len('.py')]}"
        rospy.set_param(kept, {'reported': 1.0})
        process = support.Process('rosrun', 'rbx1_nav', script)
        if line:
            process.wait_for_line(line)
        else:
            support.wait_for(lambda: commands.last and commands.last != Twist(), 'a command to move')
        process.signal(signal.SIGINT)
        self.assertEqual(process.wait(), 130, process.output)
        self.assertIn('Stopping the robot...', process.output)
        self.assertIn('Calibration terminated.', process.output)
        self.assertNotIn('Traceback', process.output)
        support.wait_for(lambda: commands.last == Twist(), 'a stop')
        self.odom.wait_for_twist(0.0)
        # the previous run is no longer valid, and an interrupted run never is
        self.assertEqual(rospy.has_param(kept), line is not None)

    def test_linear_in_motion(self):
        self.check('calibrate_linear.py')

    def test_angular_in_motion(self):
        self.check('calibrate_angular.py')

    def test_linear_at_the_question(self):
        self.check('calibrate_linear.py', 'The odometry reports')

    def test_angular_at_the_question(self):
        self.check('calibrate_angular.py', 'The gyro reports')


if __name__ == '__main__':
    support.main(TestInterruptedCalibration)
