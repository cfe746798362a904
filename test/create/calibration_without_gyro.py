#!/usr/bin/python3
"""Calibration with a gyro without power, with a loss of fractions of a degree, and with factors that are not set."""
import math
import re

import rospy

from driven import DrivenRobot
import support

FACTOR = re.compile(r'^(\w+_correction): (\S+)$', re.MULTILINE)


class TestCalibrationWithoutGyro(support.Case):
    def run_script(self, *command, answer=lambda: 360, before=lambda: None):
        """Run a script, again if the machine was too busy. before() is called before each run, answer() after it.
        Returns the output of the last run."""
        for _ in range(support.ATTEMPTS):
            before()
            script = support.Process('rosrun', 'rbx1_nav', *command)
            support.wait_for(lambda: 'The odometry reports' in script.output or script.process.poll() is not None,
                             'the end of the motion')
            if script.process.poll() is None:
                script.type(answer())
            if script.wait() == 0 or support.LATE not in script.output:
                break
        self.assertEqual(script.wait(), 0, script.output)
        return script.output

    def test_a_gyro_without_power(self):
        robot = DrivenRobot(self, 'create', {'wheel_base': 1.1, 'gyro_stuck': 12},
                            obstacle='bump')   # the gyro is never calibrated
        robot.switch('bump', False)
        robot.wait_for_status('Stationary')
        self.assertFalse(rospy.has_param('/turtlebot_node/odom_angular_scale_correction'))
        headings = []

        def mark():
            headings.append(support.yaw(robot.truth.next()))
            return f'{360 + math.degrees(support.wrapped(headings[-1] - headings[0])):.2f}'
        output = self.run_script('calibrate_angular.py', answer=mark, before=lambda: (headings.clear(), mark()))
        lines = [line for line in output.splitlines() if 'gyro' in line.lower()]
        self.assertEqual(len(lines), 1, output)
        self.assertRegex(lines[0], r'\[WARN\].* The gyro is not calibrated: the base reports an error: 12 counts: '
                                   r'expected at least 100: does it have power.*\. See /diagnostics of the base')
        factors = dict(FACTOR.findall(output))
        self.assertEqual(list(factors), ['odom_angular_scale_correction'], output)
        self.assertAlmostEqual(float(factors['odom_angular_scale_correction']) * 1.1, 1, delta=0.03)
        self.assertIn('The factor was 1.0000. Now it should be:', output)

    def test_lost_fractions(self):
        DrivenRobot(self, 'create', {'drops_fractions': True}, angle_fractions='test')
        output = self.run_script('calibrate_angular.py', '_angular_speed:=0.3')
        self.assertIn('angle_fractions: lost', output.splitlines())

    def test_the_default_factors(self):
        DrivenRobot(self, 'create')
        rospy.set_param('/turtlebot_node/odom_linear_scale_correction', 0.9)     # too late: the base has started
        output = self.run_script('calibrate_linear.py', '_goal_distance:=0.5', answer=lambda: 0.5)
        self.assertIn('The factor was 1.0000.', output)
        output = self.run_script('calibrate_angular.py')
        self.assertNotIn('not calibrated', output)
        # the default for the gyro matches create_node; the emulated gyro needs no correction
        self.assertIn('The factors were 1.0000, 1.3500.', output)
        self.assertAlmostEqual(float(dict(FACTOR.findall(output))['gyro_scale_correction']), 1, delta=0.03)


if __name__ == '__main__':
    support.main(TestCalibrationWithoutGyro)
