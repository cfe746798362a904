#!/usr/bin/python3
"""Every launch argument has a default and a description in `roslaunch --ros-args`; arguments reach the nodes."""
import subprocess

import support

LAUNCH_FILES = [('rbx1_nav', 'fake_turtlebot.launch'), ('rbx1_nav', 'fake_pi_robot.launch'),
                ('rbx1_bringup', 'fake_turtlebot.launch'), ('rbx1_bringup', 'fake_pi_robot.launch'),
                ('rbx1_bringup', 'odom_ekf.launch'), ('rbx1_bringup', 'turtlebot_minimal_create.launch'),
                ('rbx1_bringup', 'turtlebot_carpet_create.launch'), ('rbx1_bringup', 'fake_turtlebot_create.launch')]


def roslaunch(*arguments):
    """Return the output of roslaunch with these arguments."""
    return subprocess.run(['roslaunch', *arguments], check=True, timeout=support.LIMIT, stdout=subprocess.PIPE,
                          universal_newlines=True).stdout


class TestLaunchArguments(support.Case):
    def test_how_a_robot_differs_from_the_documents(self):
        for name in 'mode_plus_one', 'drops_fractions':
            for value in 'false', 'true':
                params = roslaunch('--dump-params', 'rbx1_bringup', 'fake_turtlebot_create.launch', f'{name}:={value}')
                self.assertIn(f'/fake_create/{name}: {value}\n', params)

    def test_each_launch_file_sets_the_prefix_because_any_of_them_may_be_the_first(self):
        for package, file in (('rbx1_nav', 'fake_turtlebot.launch'), ('rbx1_bringup', 'odom_ekf.launch'),
                              ('rbx1_bringup', 'turtlebot_minimal_create.launch')):
            params = roslaunch('--dump-params', package, file, 'robot:=robot2')
            self.assertIn('/robot2/tf_prefix: robot2\n', params)

    def test_seeds_of_a_fleet(self):
        for seed, second in ('7', '8'), ('random', 'random'), ('abc', 'abc'):
            params = roslaunch('--dump-params', 'rbx1_nav', 'fleet.launch', 'n:=2', f'seed:={seed}')
            self.assertRegex(params, f"/robot2/arbotix/seed: '?{second}'?\n")

    def test_no_model(self):
        arguments = '--nodes', 'rbx1_nav', 'fake_turtlebot.launch', 'surface:=low_ply_carpet'
        self.assertIn('/robot_state_publisher', roslaunch(*arguments))
        self.assertEqual(roslaunch(*arguments, 'model:=none').split(), ['/arbotix'])

    def test_arguments(self):
        texts = {}
        for package, file in LAUNCH_FILES:
            output = roslaunch('--ros-args', package, file)
            self.assertNotIn('Required', output)
            self.assertNotIn('undocumented', output)
            texts[package, file] = output
        for file in 'fake_turtlebot.launch', 'fake_pi_robot.launch':
            self.assertIn('seed (default "random")', texts['rbx1_nav', file])
            self.assertIn('surface (default "ideal")', texts['rbx1_nav', file])
            # the launch files with the tutorial's names have the same arguments
            self.assertEqual(texts['rbx1_nav', file], texts['rbx1_bringup', file])
        self.assertIn('surface (default "auto")', texts['rbx1_bringup', 'odom_ekf.launch'])


if __name__ == '__main__':
    support.main(TestLaunchArguments)
