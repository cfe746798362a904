#!/usr/bin/python3
"""A calibration script that is interrupted while driving or asking stops the robot and exits.

Without a terminal, it prints how to calculate the factor.
"""
import signal

from geometry_msgs.msg import Twist

import support


class TestInterruptedCalibration(support.Case):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.odom = support.OdomWatch()

    def check(self, script, line=None):
        """Interrupt a script in motion, or after `line`."""
        commands = self.watch_commands()
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

    def test_linear_in_motion(self):
        self.check('calibrate_linear.py')

    def test_angular_at_the_question(self):
        self.check('calibrate_angular.py', 'The gyro reports')

    def test_without_a_terminal(self):
        for node, formula in (('linear', r'METERS / 1\.\d+'), ('angular', r'DEGREES / 3\d\d\.\d')):
            process = support.Process('rosrun', 'rbx1_nav', f'calibrate_{node}.py')
            process.process.stdin.close()
            self.assertEqual(process.wait(), 0, process.output)
            self.assertRegex(process.output, rf'odom_{node}_scale_correction: 1\.0000 \* {formula}, where')


if __name__ == '__main__':
    support.main(TestInterruptedCalibration)
