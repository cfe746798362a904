#!/usr/bin/python3
"""What a reader sees on carpet: nav_ekf.rviz shows /odom_ekf and the ground truth in colours of their own, and not /odom.

Keeps its pictures where the environment variable RBX1_PICTURE_DIR says, if it is set.
"""
import os
import subprocess

import rospy
import rostest

from rviz_smoke import ARROW, PACKAGE, WAIT, RvizTest

SEEN = ('Odometry EKF', 'Ground truth')


def pixels(picture, name, where):
    """How many pixels an odometry's arrows have there."""
    return int((picture.arrows[name] & where).sum())


class RvizEkf(RvizTest):
    FILE = 'nav_ekf.rviz'

    def test_the_miss(self):
        self.start_rviz(os.path.join(self.path, self.FILE))
        before = self.wait_for('ekf_before', lambda picture: picture.ready)
        ahead = before.x > 0.4
        for name in SEEN:
            self.assertEqual(pixels(before, name, ahead), 0, 'arrows before the run: ' + name)

        subprocess.run(['rosrun', PACKAGE, 'timed_out_and_back.py'], check=True, timeout=WAIT)
        # out to 0.92 m and a half-star there; back to the left of the start, where the robot's picture hides some of it
        star = (before.x > 0.6) & (before.y > 0.05)
        home = (before.x < 0.4) & (before.y > 0.15)
        after = self.wait_for('ekf_after', lambda picture: all(
            pixels(picture, name, where) > ARROW for name in SEEN for where in (star, home)))
        self.assertFalse(after.warnings or after.errors, after.status)
        self.assertFalse(pixels(after, 'Odometry', star), 'the arrows of /odom are not ticked')
        for name in SEEN:
            self.assertFalse(pixels(after, name, before.y < -0.05), 'arrows to the right: ' + name)
        self.assertEqual(self.console_errors(), [])
        self.assertEqual(self.rosout, [])


if __name__ == '__main__':
    rospy.init_node('rviz_ekf')
    rostest.rosrun(PACKAGE, 'rviz_ekf', RvizEkf)
