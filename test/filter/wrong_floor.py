#!/usr/bin/python3
"""A filter that assumes a different floor than the true one has the heading of the gyro, and covers its error."""
import math

from geometry_msgs.msg import PoseWithCovarianceStamped
from nav_msgs.msg import Odometry
from rosgraph_msgs.msg import Log

import support


class TestWrongFloor(support.Case):
    def test_the_uncertainty_covers_the_difference(self):
        log, truth = support.Watch('/rosout', Log), support.Watch('/ground_truth', Odometry)
        right, wrong = (support.Watch(f'/{name}/odom_combined', PoseWithCovarianceStamped)
                        for name in ('right', 'wrong'))
        support.wait_for(lambda: min(len(right.messages), len(wrong.messages)) > 60, 'two seconds of both filters')
        driver = support.out_and_back()
        self.assertEqual(driver.wait(), 0, driver.output)
        true = support.pose(truth.next())
        right.next()
        wrong.next()

        self.assertEqual([(m.name, m.msg) for m in list(log.messages) if 'imu_data' in m.msg], [])
        # the heading follows the gyro, whatever is assumed about the wheels
        for estimate in right, wrong:
            pose, covariance = estimate.last.pose.pose, estimate.last.pose.covariance
            self.assertLess(abs(support.wrapped(support.yaw(estimate.last) - true[2])), math.radians(4))
            for error, variance in ((pose.position.x - true[0], covariance[0]),
                                    (pose.position.y - true[1], covariance[7])):
                self.assertLess(abs(error), 4 * math.sqrt(variance))


if __name__ == '__main__':
    support.main(TestWrongFloor)
