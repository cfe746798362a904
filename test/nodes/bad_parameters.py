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
                ('timed_out_and_back', '_rate:=0', '/rate', '0'),
                ('timed_out_and_back', '_linear_speed:=-0.2', '/linear_speed', '-0.2'),
                ('timed_out_and_back', '_angular_speed:=.nan', '/angular_speed', 'nan'),
                ('timed_out_and_back', '_goal_distance:=far', '/goal_distance', "'far'"),
                ('timed_out_and_back', '_goal_angle:=true', '/goal_angle', 'True'),
                ('timed_out_and_back', '_linear_speed:=1.0e+5', 'goal_distance 1.0'),
                ('timed_out_and_back', '_linear_speed:=1.0e+300', '/linear_speed', '1e+300'),
                ('odom_out_and_back', '_min_linear_speed:=-1', '/min_linear_speed', '-1'),
                ('odom_out_and_back', '_transform_timeout:=0', '/transform_timeout', '0'),
                ('odom_out_and_back', '_odom_frame:=7', '/odom_frame', '7'),
                ('odom_out_and_back', '_base_frame:=a b', '/base_frame', "'a b'"),
                ('calibrate_linear', '_goal_distance:=0', '/calibrate_linear/goal_distance: 0:', 'from 0.1 to 100'),
                ('calibrate_linear', '_base_node:=7', '/calibrate_linear/base_node: 7: expected the name of a node'),
                ('calibrate_angular', '_turns:=many', '/calibrate_angular/turns', "'many'")]:
            self.check(support.Process('rosrun', 'rbx1_nav', f'{script}.py', argument), [*expected, 'expected'])
            forget('/out_and_back' if 'out' in script else f'/{script}')
        self.assertFalse([each for each in commands.messages if each != Twist()])   # a script that gives up stops

    def test_filter(self):
        for params, expected in [
                ({'freq': 1e-300}, ['/freq: 1e-300: expected a rate from 0.1 to 1000 in Hz']),
                ({'sensor_timeout': 'long'}, ['sensor_timeout', "'long'"]),
                ({'imu_used': 1}, ['imu_used', '1', 'true or false']), ({'output_frame': ''}, ['output_frame', "''"]),
                ({'odom_used': False}, ['odom_used', 'False', 'expected true']),
                ({'vo_used': 'no'}, ['vo_used', "'no'", 'true or false']),
                ({'base_footprint_frame': 'a b'}, ['base_footprint_frame', "'a b'", 'the name of a frame']),
                ({'tf_prefix': 7}, ['tf_prefix', '7', 'the name of a frame']),
                ({'max_speed': 0}, ['/max_speed: 0: expected a speed from 0.01 to 1000 in m/s']),
                ({'gyro_bias': 'small'}, ['/gyro_bias', "'small'", 'from 0.01 to 1000 in degrees/s']),
                ({'surface': 'sand'}, ['surface', "'sand'", f'expected one of {support.surfaces()}'])]:
            rospy.set_param('/robot_pose_ekf', params)
            self.check(support.Process('rosrun', 'rbx1_nav', 'ekf.py'), expected)
            rospy.delete_param('/robot_pose_ekf')

    def test_base(self):
        for params, expected in [
                ({}, ['/arbotix/controllers', 'missing']),
                ({'controllers': {'base': dict(BASE, base_width=0)}}, ['base/base_width', '0', 'from 0.001']),
                ({'controllers': {'two\nlines': 7}}, [r"/arbotix/controllers/'two\nlines'", '7', 'a mapping']),
                ({'controllers': {'base': BASE}, 'surface': 'sand'},
                 ['/arbotix/surface', "'sand'", f'expected one of {support.surfaces()}']),
                ({'controllers': {'base': BASE}, 'seed': -1}, ['/arbotix/seed', '-1', 'integer']),
                ({'controllers': {'base': BASE}, 'real_time_factor': 5}, ['real_time_factor', '5', '/use_sim_time']),
                ({'controllers': {'base': BASE}, 'strict': True}, ['strict: true: expected a simulated clock']),
                ({'controllers': {'base': BASE}, 'real_time_factor': 1e-300}, ['1e-300: expected a number from 0.01'])]:
            if params:
                rospy.set_param('/arbotix', params)
            self.check(support.Process('rosrun', 'rbx1_nav', 'fake_base.py'), expected)
            if params:
                rospy.delete_param('/arbotix')

    def test_web_view(self):
        for params, expected in [({'address': ''}, ["/address: '': expected a text of 1"]),
                                 ({'address': '192.0.2.1'}, ['address 192.0.2.1, port 8080', 'expected an address']),
                                 ({'linear_speed': 0}, ['/linear_speed: 0: expected']),
                                 ({'angular_speed': 9}, ['/angular_speed: 9: expected']),
                                 ({'port': 70000}, ['/port: 70000: expected a TCP port from 0 to 65535'])]:
            rospy.set_param('/web_view', params)
            self.check(support.Process('rosrun', 'rbx1_nav', 'web_view.py'), expected)
            rospy.delete_param('/web_view')


if __name__ == '__main__':
    support.main(TestBadParameters)
