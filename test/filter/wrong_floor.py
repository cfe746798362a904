#!/usr/bin/python3
"""A filter that assumes a different floor than the true one detects this and increases the distance uncertainty."""
import math
import unittest

from geometry_msgs.msg import PoseWithCovarianceStamped
from nav_msgs.msg import Odometry
from rosgraph_msgs.msg import Log

import support


class TestWrongFloor(unittest.TestCase):
    def test_it_is_noticed(self):
        support.init_node('wrong_floor')
        log, truth = support.Watch('/rosout', Log), support.Watch('/ground_truth', Odometry)
        right, wrong = (support.Watch(f'/{name}/odom_combined', PoseWithCovarianceStamped)
                        for name in ('right', 'wrong'))
        support.wait_for(lambda: min(len(right.messages), len(wrong.messages)) > 60, 'two seconds of both filters')
        driver = support.out_and_back()
        self.addCleanup(driver.kill)
        self.assertEqual(driver.wait(), 0, driver.output)
        true_yaw = support.yaw(truth.next())
        right.next()
        wrong.next()

        noticed = [(m.name, m.msg) for m in list(log.messages) if 'does not match the assumed floor' in m.msg]
        self.assertEqual([name for name, _ in noticed], ['/wrong'], noticed)
        self.assertRegex(noticed[0][1], r'^odom turned by \d+\.\d\d rad, imu_data by \d+\.\d\d rad: ')
        variances = {m.header.stamp: m.pose.covariance[0] for m in list(right.messages)}
        ratios = [m.pose.covariance[0] / variances[m.header.stamp] for m in list(wrong.messages)
                  if m.header.stamp in variances]
        self.assertGreater(len(ratios), 100)
        # on the first leg, it was at least as certain as on carpet: the base reports the carpet's noise
        self.assertLess(ratios[len(ratios) // 4], 1.1)
        self.assertGreater(max(ratios), 1.5)
        # the heading follows the gyro, whatever is assumed about the wheels
        for estimate in right, wrong:
            self.assertLess(abs(support.wrapped(support.yaw(estimate.last) - true_yaw)), math.radians(4))


if __name__ == '__main__':
    support.main('wrong_floor', TestWrongFloor)
