#!/usr/bin/python3
"""A node with an invalid parameter exits with one line that contains the key, the value and what is expected."""
import rospy
from geometry_msgs.msg import Twist

import support

BASE = {'type': 'diff_controller', 'base_width': 0.26}


def forget(name):
    """Delete the parameters that a node has left on the master; a node that was never registered leaves none."""
    if rospy.has_param(name):
        rospy.delete_param(name)


class TestBadParameters(support.Case):
    def check(self, process, expected):
        """Check that the process exits with status 1 and one error that contains all expected texts."""
        self.assertEqual(process.wait(), 1, process.output)
        errors = [line for line in process.lines if '[ERROR]' in line or '[FATAL]' in line]
        self.assertEqual(len(errors), 1, process.output)
        for text in expected:
            self.assertIn(text, errors[0])
        self.assertNotIn('Traceback', process.output)

    def test_driving(self):
        commands = support.Watch('/cmd_vel', Twist)
        for script, argument, *expected in [
                ('timed_out_and_back', '_goal_distance:=far', '/goal_distance', "'far'"),
                ('timed_out_and_back', '_linear_speed:=1.0e+5', 'goal_distance 1.0'),
                ('odom_out_and_back', '_odom_frame:=7', '/odom_frame', '7'),
                ('calibrate_linear', '_base_node:=7', '/calibrate_linear/base_node: 7: expected the name of a node'),
                ('calibrate_angular', '_turns:=many', '/calibrate_angular/turns', "'many'")]:
            self.check(support.Process('rosrun', 'rbx1_nav', f'{script}.py', argument), [*expected, 'expected'])
            forget('/out_and_back' if 'out' in script else f'/{script}')
        self.assertFalse([each for each in commands.messages if each != Twist()])   # a script that gives up stops

    def test_filter(self):
        rospy.set_param('/robot_pose_ekf', {'surface': 'sand'})
        self.addCleanup(rospy.delete_param, '/robot_pose_ekf')
        self.check(support.Process('rosrun', 'rbx1_nav', 'ekf.py'),
                   ["/robot_pose_ekf/surface: 'sand'", f'expected one of {support.surfaces()}'])

    def test_emulated_robot(self):
        self.check(support.Process('rosrun', 'rbx1_nav', 'fake_create.py', '_link:=/etc/hostname'),
                   ['link: /etc/hostname: exists, and is not a link: expected'])
        forget('/fake_create')

    def test_base(self):
        for params, expected in [
                ({}, ['/arbotix/controllers', 'missing']),
                ({'controllers': {'two\nlines': 7}}, [r"/arbotix/controllers/'two\nlines'", '7', 'a mapping']),
                ({'controllers': {'base': BASE}, 'surface': 'sand'},
                 ['/arbotix/surface', "'sand'", f'expected one of {support.surfaces()}']),
                ({'controllers': {'base': BASE}, 'real_time_factor': 5}, ['real_time_factor', '5', '/use_sim_time']),
                ({'controllers': {'base': BASE}, 'strict': True}, ['strict: true: expected a simulated clock'])]:
            if params:
                rospy.set_param('/arbotix', params)
            self.check(support.Process('rosrun', 'rbx1_nav', 'fake_base.py'), expected)
            if params:
                rospy.delete_param('/arbotix')

    def test_web_view(self):
        for params, expected in [({'address': '192.0.2.1'}, ['address 192.0.2.1, port 8080', 'expected an address']),
                                 ({'port': 70000}, ['/port: 70000: expected a TCP port from 0 to 65535'])]:
            rospy.set_param('/web_view', params)
            self.check(support.Process('rosrun', 'rbx1_nav', 'web_view.py'), expected)
            rospy.delete_param('/web_view')


if __name__ == '__main__':
    support.main(TestBadParameters)
