#!/usr/bin/python3
"""roslaunch --ros-args lists no argument as required: each has a default that says something."""
import subprocess
import unittest

import support

LAUNCH_FILES = [('rbx1_nav', 'fake_turtlebot.launch'), ('rbx1_nav', 'fake_pi_robot.launch'),
                ('rbx1_bringup', 'fake_turtlebot.launch'), ('rbx1_bringup', 'fake_pi_robot.launch'),
                ('rbx1_bringup', 'odom_ekf.launch'), ('rbx1_bringup', 'turtlebot_minimal_create.launch'),
                ('rbx1_bringup', 'turtlebot_carpet_create.launch'), ('rbx1_bringup', 'fake_turtlebot_create.launch')]


class TestLaunchArguments(unittest.TestCase):
    def test_arguments(self):
        texts = {}
        for package, file in LAUNCH_FILES:
            output = subprocess.run(['roslaunch', '--ros-args', package, file], check=True, timeout=support.LIMIT,
                                    stdout=subprocess.PIPE, universal_newlines=True).stdout
            self.assertNotIn('Required', output)
            self.assertNotIn('undocumented', output)
            texts[package, file] = output
        for file in 'fake_turtlebot.launch', 'fake_pi_robot.launch':
            self.assertIn('seed (default "random")', texts['rbx1_nav', file])
            self.assertIn('surface (default "ideal")', texts['rbx1_nav', file])
            # the tutorial's names have the same arguments
            self.assertEqual(texts['rbx1_nav', file], texts['rbx1_bringup', file])
        self.assertIn('surface (default "auto")', texts['rbx1_bringup', 'odom_ekf.launch'])


if __name__ == '__main__':
    support.main('launch_arguments', TestLaunchArguments)
