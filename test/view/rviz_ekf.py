#!/usr/bin/python3
"""Tests nav_ekf.rviz on carpet: only the arrows of /odom_ekf are shown. If all three displays are ticked, the arrows
have the right colors; the robot at the true pose is solid, and the robot at the odometry pose is transparent.

If the environment variable RBX1_PICTURE_DIR is set, the screenshots are saved in that directory.
"""
import os
import subprocess

import numpy
from nav_msgs.msg import Odometry
import yaml

import support
from rviz_smoke import ARROW, PACKAGE, WAIT, RvizTest

ARROWS = ('Odometry (red)', 'Odometry EKF (green)', 'Ground truth (blue)')
RADIUS = 0.165      # m, radius of the robot


def arrow_pixels(picture, name, where):
    """Return the number of pixels of these arrows within a mask."""
    return int((picture.arrows[name] & where).sum())


def distance(picture, odom):
    """Return the distance of each pixel from the position in an Odometry message, m."""
    return numpy.hypot(picture.x - odom.pose.pose.position.x, picture.y - odom.pose.pose.position.y)


class RvizEkf(RvizTest):
    FILE = 'nav_ekf.rviz'

    def tick_all(self):
        """Return the path of a copy of the file in which all displays of arrows are ticked."""
        with open(os.path.join(self.path, self.FILE), encoding='utf-8') as file:
            config = yaml.safe_load(file)
        arrows = [each for each in config['Visualization Manager']['Displays'] if each['Name'] in ARROWS]
        self.assertEqual([each['Name'] for each in arrows if each['Enabled']], ['Odometry EKF (green)'])
        for each in arrows:
            each['Enabled'] = each['Value'] = True
        return self.file(yaml.safe_dump(config), '.rviz')

    def test_the_miss(self):
        truth, reported = support.Watch('/ground_truth', Odometry), support.Watch('/odom', Odometry)
        self.start_rviz(self.tick_all())
        before = self.wait_for('ekf_before', lambda picture: picture.ready)
        ahead = before.x > 0.4
        for name in ARROWS:
            self.assertEqual(arrow_pixels(before, name, ahead), 0, f'arrows before the run: {name}')

        subprocess.run(['rosrun', PACKAGE, 'timed_out_and_back.py'], check=True, timeout=WAIT)
        # a half-star at 0.92 m, and one to the left of the start, where the robot hides some of the arrows
        star = (before.x > 0.6) & (before.y > 0.05)
        home = (before.x < 0.4) & (before.y > 0.15)
        after = self.wait_for('ekf_after', lambda picture: all(
            arrow_pixels(picture, name, where) > ARROW for name in ARROWS for where in (star, home)))
        self.assertFalse(after.warnings or after.errors, after.status)
        for name in ARROWS:
            self.assertFalse(arrow_pixels(after, name, before.y < -0.05), f'arrows to the right: {name}')

        # the solid robot is white on its rim; the transparent one is visible where the other does not cover it
        from_truth, from_odometry = distance(after, truth.last), distance(after, reported.last)
        rim = (from_truth > 0.6 * RADIUS) & (from_truth < 0.95 * RADIUS)
        self.assertGreater((after.white & rim).sum(), 0.4 * rim.sum(), 'the true robot is not solid')
        crescent = (from_odometry < 0.95 * RADIUS) & (from_truth > 1.2 * RADIUS)
        self.assertGreater(crescent.sum(), 500, 'odometry and truth are too close to distinguish the robots')
        self.assertGreater((after.ghost & crescent).sum(), 0.8 * crescent.sum(), 'no transparent robot')
        self.assertEqual(self.console_errors(), [])
        self.assertEqual(self.rosout, [])


if __name__ == '__main__':
    support.main(RvizEkf)
