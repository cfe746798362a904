#!/usr/bin/python3
"""calibrate_angular.py finds the errors of wheels and gyro in a turn."""
import math
import re

from geometry_msgs.msg import Twist
import rospy

import support

ODOM_FACTOR, GYRO_FACTOR = 0.9, 1.2     # in force; the simulated base does not use them


class TestAngularCalibration(support.Case):
    def test_it_finds_both_errors(self):
        rospy.set_param('/arbotix/odom_angular_scale_correction', ODOM_FACTOR)
        rospy.set_param('/arbotix/gyro_scale_correction', GYRO_FACTOR)
        odom, truth = support.OdomWatch(), support.Watch('/ground_truth', support.Odometry)
        script = support.Process('rosrun', 'rbx1_nav', 'calibrate_angular.py', '_turns:=2', '_base_node:=arbotix')
        script.wait_for_line('The gyro reports')
        # both differ from two turns
        real, reported = (720 + math.degrees(support.wrapped(support.yaw(topic.next()))) for topic in (truth, odom))
        # on carpet the wheels slip by 3 % in turns, with a standard deviation of 2 % over two turns
        self.assertGreater(abs(reported - real), 3)

        script.type(f'{real:.1f}')
        self.assertEqual(script.wait(), 0, script.output)
        factors = {key: float(value) for key, value in re.findall(r'^(\w+_correction): (\S+)$', script.output,
                                                                  re.MULTILINE)}
        self.assertEqual(len(factors), 2, script.output)
        # rounding of 0.2 degrees in 720
        self.assertAlmostEqual(factors['odom_angular_scale_correction'], ODOM_FACTOR * real / reported, delta=0.0005)
        # the gyro's scale error has a standard deviation of 0.3 %; with this seed the error is below two of these
        self.assertAlmostEqual(factors['gyro_scale_correction'], GYRO_FACTOR, delta=0.006 * GYRO_FACTOR)

    def test_the_gyro_was_not_at_rest(self):      # the last test: it turns the robot
        commands, commander = support.Watch('/cmd_vel', Twist), support.Commander()
        script = support.Process('rosrun', 'rbx1_nav', 'calibrate_angular.py')

        def drive():
            commander.send(0.0, 0.3)
            return any(each.angular.z > 0.3 for each in commands.messages)
        support.wait_for(drive, 'the turn')
        script.wait_for_line(r'The gyro is not calibrated: the robot turned by \d+\.\d degrees before the turn')
        script.type('360')
        self.assertEqual(script.wait(), 0, script.output)
        self.assertNotIn('gyro_scale_correction', script.output)


if __name__ == '__main__':
    support.main(TestAngularCalibration)
