#!/usr/bin/python3
"""At its start, the base logs one line on ignored keys, the surface with the seed, and its pose, and nothing else."""
import os
import re

import rospkg
import rospy
import yaml

import support


class TestStartMessages(support.Case):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        with open(os.path.join(rospkg.RosPack().get_path('rbx1_nav'), 'config', 'turtlebot.yaml')) as file:
            cls.config = yaml.safe_load(file)

    def base(self, **params):
        """Start a base with the package's own configuration and these parameters."""
        rospy.set_param('/arbotix', dict(self.config, **params))
        return support.Process('rosrun', 'rbx1_nav', 'fake_base.py')

    def messages(self, **params):
        """Return the levels and texts that a base logs until it is ready."""
        base = self.base(**params)
        base.wait_for_line('Ready')
        base.kill()
        return [re.sub(r'^\[(\w+)\] \[.*?\]: ', r'\1 ', line) for line in base.lines]

    def test_ideal(self):
        self.assertEqual(self.messages(), [
            'INFO Ignoring 13 parameters that apply only to hardware', 'INFO Surface: ideal',
            'INFO Ready: base_footprint is at the origin of odom'])

    def test_a_seed(self):
        self.assertIn('INFO Surface: low_ply_carpet; seed:=3 repeats this run',
                      self.messages(surface='low_ply_carpet', seed='3'))

    def test_a_random_seed(self):
        lines = [line for _ in range(2) for line in self.messages(surface='hard_floor', seed='random')
                 if re.fullmatch(r'INFO Surface: hard_floor; seed:=\d+ repeats this run', line)]
        self.assertEqual(len(set(lines)), 2, lines)

    def test_an_unknown_key(self):
        config = yaml.safe_load(yaml.safe_dump(self.config))
        config['controllers']['base_controller']['time_out'] = 2
        self.assertIn('WARN Ignoring unknown parameters: controllers/base_controller/time_out '
                      '(did you mean timeout?)', self.messages(**config))

    def test_a_surface_file_that_does_not_exist(self):
        base = self.base(surface='/nowhere/sand.yaml')
        self.assertEqual(base.wait(), 1)
        self.assertEqual(len(base.lines), 1, base.output)
        self.assertIn("/arbotix/surface: '/nowhere/sand.yaml': no such file: expected the absolute path of a surface "
                      f'file, or one of {support.surfaces()}', base.lines[0])


if __name__ == '__main__':
    support.main(TestStartMessages)
