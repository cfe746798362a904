#!/usr/bin/python3
"""The estimate as nav_msgs/Odometry has the pose of ~odom_combined, and a velocity that agrees with its covariance."""
import math

from geometry_msgs.msg import PoseWithCovarianceStamped
from nav_msgs.msg import Odometry

import support


class TestOdometryOutput(support.Case):
    def test_pose_and_velocity(self):
        truth = support.Watch('/ground_truth', Odometry)
        poses = support.Watch('/robot_pose_ekf/odom_combined', PoseWithCovarianceStamped)
        poses.wait_for_publisher('/robot_pose_ekf')     # each estimate has a pose, which is published before it
        estimates = support.Watch('/robot_pose_ekf/odometry', Odometry)
        # the filter estimates the gyro bias at standstill
        support.wait_for(lambda: truth.last and len(estimates.messages) > 60, 'estimates at standstill')
        driver = support.out_and_back()
        self.assertEqual(driver.wait(), 0, driver.output)
        checked = list(estimates.messages)[2:]      # the first have no predecessor
        support.wait_for(lambda: poses.last.header.stamp >= checked[-1].header.stamp, 'the last pose')
        by_stamp = {m.header.stamp: m.pose for m in list(poses.messages)}
        for message in checked:
            self.assertEqual((message.header.frame_id, message.child_frame_id), ('odom_combined', 'base_footprint'))
            self.assertEqual(message.pose, by_stamp[message.header.stamp])
            self.assertEqual([message.twist.covariance[7 * axis] for axis in (2, 3, 4)], [1e6] * 3)

        # the twist of /ground_truth is the twist of the motors; only the poses contain the carpet's noise
        true = {}
        for before, after in zip(truth.messages, truth.messages[1:]):
            elapsed = (after.header.stamp - before.header.stamp).to_sec()
            (x, y, yaw), (end_x, end_y, end_yaw) = support.pose(before), support.pose(after)
            turn = support.wrapped(end_yaw - yaw)
            middle = yaw + turn / 2
            true[after.header.stamp] = (((end_x - x) * math.cos(middle) + (end_y - y) * math.sin(middle)) / elapsed,
                                        turn / elapsed)
        moving = [(m.twist, *true[m.header.stamp]) for m in checked
                  if m.header.stamp in true and max(map(abs, true[m.header.stamp])) > 0.1]
        self.assertGreater(len(moving), 300)
        # m/s: within a cell of the carpet, the odometry of 0.2 m/s has an error of 14 %, 1 sigma
        self.check([(t.twist.linear.x - speed, t.covariance[0]) for t, speed, _ in moving], 0.04)
        # rad/s: from the gyro noise of 0.1 degrees/s, its bias, and its scale error of 0.3 %
        self.check([(t.twist.angular.z - turn, t.covariance[35]) for t, _, turn in moving], 0.008)

    def check(self, errors, limit):
        """Check that the rms error is below a limit and not much above the variances. errors: (error, variance)."""
        self.assertLess(math.sqrt(sum(error ** 2 for error, _ in errors) / len(errors)), limit)
        self.assertLess(sum(error ** 2 / variance for error, variance in errors) / len(errors), 2)


if __name__ == '__main__':
    support.main(TestOdometryOutput)
