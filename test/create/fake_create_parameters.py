#!/usr/bin/python3
"""An invalid parameter ends fake_create.py with one line that names the key, the value and what is expected."""
import unittest

import rospy

import support


class TestParameters(unittest.TestCase):
    def test_bad_parameters(self):
        support.init_node('fake_create_parameters')
        for params, expected in [
                (7, 'configuration: 7: expected a mapping'),
                ({'robot_type': 'roomba'}, "robot_type: 'roomba': expected one of create, create2"),
                ({'robot_type': 2}, 'robot_type: 2: expected one of create, create2'),
                ({'robot_type': ['create']}, "robot_type: ['create']: expected one of create, create2"),
                ({'link': 7}, 'link: 7: expected a path'),
                ({'link': '/no/such/folder/port'}, 'link: /no/such/folder/port: No such file or directory: expected'),
                ({'link': '/etc/hostname'}, 'link: /etc/hostname: exists, and is not a link: expected'),
                ({'surface': 'sand'}, "surface: 'sand': expected one of create_lab_floor, hard_floor, ideal, low_ply"),
                ({'seed': -1}, 'seed: -1: expected random, or an integer'),
                ({'charge': 2}, 'charge: 2: expected a number from 0 to 1'),
                ({'corruption': 'some'}, "corruption: 'some': expected a number from 0 to 1"),
                ({'wheel_base': 0}, 'wheel_base: 0: expected a factor from 0.1 to 10'),
                ({'gyro_measurement_range': 0}, 'gyro_measurement_range: 0: expected a number from 1')]:
            rospy.set_param('/fake_create', params)
            process = support.Process('rosrun', 'rbx1_nav', 'fake_create.py')
            self.addCleanup(process.kill)
            self.assertEqual(process.wait(), 1, process.output)
            errors = [line for line in process.lines if '[FATAL]' in line]
            self.assertEqual(len(errors), 1, process.output)
            self.assertIn('/fake_create/' + expected, errors[0])
            self.assertNotIn('Traceback', process.output)
            rospy.delete_param('/fake_create')


if __name__ == '__main__':
    support.main('fake_create_parameters', TestParameters)
