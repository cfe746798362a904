#!/usr/bin/python3
"""Tests nav_ekf.rviz without a surface: RViz shows one solid robot and no errors.

If the environment variable RBX1_PICTURE_DIR is set, the screenshots are saved in that directory.
"""
import os
import subprocess
import sys

import support
from rviz_ekf import ARROWS, arrow_pixels
from rviz_smoke import ARROW, PACKAGE, WAIT, RvizTest


class RvizOneRobot(RvizTest):
    FILE = 'nav_ekf.rviz'

    def test_one_solid_robot(self):
        self.start_rviz(os.path.join(self.path, self.FILE))
        before = self.wait_for(f'{NAME}_before', lambda picture: picture.ready)
        subprocess.run(['rosrun', PACKAGE, 'timed_out_and_back.py'], check=True, timeout=WAIT)
        star = (before.x > 0.6) & (before.y > 0.05)
        # if all poses are equal, the arrows of one topic may cover the arrows of another
        after = self.wait_for(f'{NAME}_after', lambda picture: picture.ready and sum(
            arrow_pixels(picture, name, star) for name in ARROWS) > 5 * ARROW)
        # a second robot would double the number of orange pixels; the edges of arrows are counted as well
        self.assertLess(after.marks.sum(), 1.75 * after.robot())
        self.assertFalse(after.errors, after.status)
        self.assertEqual(self.console_errors(), [])
        self.assertEqual(self.rosout, [])


if __name__ == '__main__':
    NAME = sys.argv[1]
    support.main(RvizOneRobot)
