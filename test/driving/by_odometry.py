#!/usr/bin/python3
"""odom_out_and_back.py returns to the start.

usage: by_odometry.py FRAME METERS DEGREES [TOPIC...] --

The script measures the pose in FRAME. Its true end pose on /ground_truth must be within METERS and DEGREES of the
start. The test first waits for a message on each TOPIC.
"""
import math
import sys

import rospy

import support


class TestByOdometry(support.Case):
    def test_it_ends_near_the_start(self):
        frame, metres, degrees, *topics = sys.argv[1:sys.argv.index('--')]
        truth = support.Watch('/ground_truth', support.Odometry)
        support.wait_for(lambda: truth.last, '/ground_truth')
        for topic in topics:
            rospy.wait_for_message(topic, rospy.AnyMsg, support.LIMIT)
        # the filter estimates the gyro bias at standstill, for 2 s as in extras/many_runs/simulated_run.py
        start = truth.last.header.stamp
        support.wait_for(lambda: (truth.last.header.stamp - start).to_sec() > 2, 'two seconds')

        driver = support.by_odometry(f'_odom_frame:={frame}')
        self.assertEqual(driver.wait(), 0, driver.output)
        x, y, yaw = support.pose(truth.next())
        self.assertGreater(max(message.pose.pose.position.x for message in truth.messages), 0.9)
        self.assertLess(math.hypot(x, y), float(metres))
        self.assertLess(abs(math.degrees(support.wrapped(yaw))), float(degrees))


if __name__ == '__main__':
    support.main(TestByOdometry)
