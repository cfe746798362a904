#!/usr/bin/python3
"""calibrate_linear.py measures the slip of the wheels; with its factor, the odometry would report the truth."""
import math
import re

import rospy

import support


class TestLinearCalibration(support.Case):
    def test_it_finds_the_slip(self):
        rospy.set_param('/turtlebot_node/odom_linear_scale_correction', 0.8)   # of a base that has ended
        odom, truth = support.OdomWatch(), support.Watch('/ground_truth', support.Odometry)
        script = support.Process('rosrun', 'rbx1_nav', 'calibrate_linear.py')
        script.wait_for_line('/turtlebot_node is not running')
        script.wait_for_line('The odometry reports')
        real, reported = (math.hypot(*support.pose(topic.next())[:2]) for topic in (truth, odom))
        # on carpet the wheels slip by 2 % on average, with a standard deviation of 4 % over 1 m
        self.assertGreater(abs(reported - real), 0.003)

        for answer, shown in [('about 1', "'about 1'"), (f'{100 * real:.0f}', r'9\d.0')]:
            script.type(answer)
            script.wait_for_line(f'measured: {shown}: expected a distance from')
        script.type(f'{real:.3f}')
        self.assertEqual(script.wait(), 0, script.output)
        # the reported distance is rounded to millimeters
        shown = float(re.search(r'The odometry reports (\S+) m', script.output)[1])
        self.assertAlmostEqual(shown, reported, delta=0.0006)
        factor = float(re.search(r'^odom_linear_scale_correction: (\S+)$', script.output, re.MULTILINE)[1])
        # rounding of the answer, 1 mm in 1 m, and of the last decimal of the factor
        self.assertAlmostEqual(factor, real / reported, delta=0.0007)


if __name__ == '__main__':
    support.main(TestLinearCalibration)
