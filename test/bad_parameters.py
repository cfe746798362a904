#!/usr/bin/python3
"""What makes no sense ends a node with one line that names key, value and expectation."""
import unittest

import rospy
from geometry_msgs.msg import Twist

import support

BASE = {'type': 'diff_controller', 'base_width': 0.26}


class TestBadParameters(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        support.init_node('bad_parameters')

    def check(self, process, expected):
        self.addCleanup(process.kill)
        self.assertEqual(process.wait(), 1, process.output)
        complaints = [line for line in process.lines if '[ERROR]' in line or '[FATAL]' in line]
        self.assertEqual(len(complaints), 1, process.output)
        for text in expected:
            self.assertIn(text, complaints[0])
        self.assertNotIn('Traceback', process.output)

    def test_driver(self):
        heard = support.Watch('/cmd_vel', Twist)
        for argument, name, value in [('_rate:=0', '/rate', '0'), ('_linear_speed:=-0.2', '/linear_speed', '-0.2'),
                                      ('_angular_speed:=.nan', '/angular_speed', 'nan'),
                                      ('_goal_distance:=far', '/goal_distance', "'far'"),
                                      ('_goal_angle:=true', '/goal_angle', 'True'),
                                      ('_linear_speed:=1.0e+300', '1e+300', 'between 1 tick and a day')]:
            self.check(support.out_and_back(argument), [name, value, 'expected'])
            rospy.delete_param('/out_and_back')
        self.assertFalse(heard.messages)

    def test_base(self):
        for params, expected in [
                ({}, ['/arbotix/controllers', 'missing']),
                ({'controllers': {'base': dict(BASE, base_width=0)}}, ['base/base_width', '0', 'above 0']),
                ({'controllers': {'base': dict(BASE, rate=-1)}}, ['base/rate', '-1', 'above 0']),
                ({'controllers': {'base': dict(BASE, type='arm')}}, ['base/type', "'arm'", 'diff_controller']),
                ({'controllers': {'base': BASE}, 'real_time_factor': 5}, ['real_time_factor', '5', '/use_sim_time'])]:
            if params:
                rospy.set_param('/arbotix', params)
            self.check(support.Process('rosrun', 'rbx1_nav', 'fake_base.py'), expected)
            if params:
                rospy.delete_param('/arbotix')


if __name__ == '__main__':
    support.main('bad_parameters', TestBadParameters)
