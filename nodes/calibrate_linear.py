#!/usr/bin/env python3
"""Calibrates the distance that the odometry reports: drives 1 m by odometry, asks how far it really was.

usage: calibrate_linear.py [_parameter:=value ...] [topic:=new_topic ...]
example: rosrun rbx1_nav calibrate_linear.py _goal_distance:=2

Parameters:
    ~goal_distance      how far to drive, m (default: 1)
    ~linear_speed       forward speed, m/s (default: 0.15)
    ~min_linear_speed   lowest speed near the goal, m/s (default: 0.05)
    ~rate               commands per second, Hz (default: 50)
    ~odom_frame         frame of the odometry (default: odom)
    ~base_frame         frame of the robot (default: base_footprint or base_link, whichever exists)
    ~base_node          node whose parameter is calibrated (default: turtlebot_node)
    ~wait_timeout       how long to wait for roscore, for a base, and for its pose, s (default: 30)
    ~measured           how far the robot went in the last run, m: in place of an answer; does not drive

Put a tape on the floor, the zero at a mark on the robot. The odometry should report what you measure: if the robot went
less far than it reports, the factor becomes smaller.
"""
from rbx1_nav.ros.driving.script import exit_status, frame_param, init_node, positive_param

from math import hypot
import sys

import rospy

from rbx1_nav.control.legs import Straight
from rbx1_nav.robot.calibration import corrected, read_measured
from rbx1_nav.ros.driving.calibration import factor_in_force, forget_run, load_run, node_param, save_run, take_measured
from rbx1_nav.ros.driving.pose_drive import CalibrationDrive
from rbx1_nav.ros.driving.pose_listener import PoseListener
from rbx1_nav.ros.node.question import ask

KEY = 'odom_linear_scale_correction'


def measure():
    """Drive once. Returns what the odometry reported, m, and the factor with which it did."""
    rate = positive_param('rate', 50, 2, 1000)                          # Hz
    linear_speed = positive_param('linear_speed', 0.15)                 # m/s
    leg = Straight('forward',
                   positive_param('goal_distance', 1.0, 0.1, 100),      # m
                   linear_speed,
                   positive_param('min_linear_speed', 0.05),            # m/s
                   rate)
    base_node = node_param('base_node', 'turtlebot_node')
    poses = PoseListener(frame_param('odom_frame', 'odom'), frame_param('base_frame', None), linear_speed, 0.0)
    forget_run('linear')
    with CalibrationDrive(rate, poses) as drive:
        factor = factor_in_force(base_node, KEY)
        drive.drive(leg)
    # A tape measures from mark to mark, not along the robot's first heading.
    return {'reported': hypot(leg.last.x - leg.start.x, leg.last.y - leg.start.y), KEY: factor}


def calibrate():
    """Drive, ask, and print the factor."""
    init_node('calibrate_linear', __doc__)
    measured = take_measured()
    if measured is None:
        run = measure()
        save_run('linear', run)
    else:
        run = load_run('linear', 'reported', KEY)
    print(f"The odometry reports {run['reported']:.3f} m.")

    def check(answer):
        return read_measured('measured', answer, run['reported'], 'a distance', 'm')

    measured = ask('How far is the robot from its start, in m?', check) if measured is None else check(measured)
    if measured is None:
        print('Measure how far the robot is from its start, in m. Then: rosrun rbx1_nav calibrate_linear.py '
              '_measured:=METRES')
        return
    factor = corrected(KEY, run[KEY], measured, run['reported'])
    print(f'The factor was {run[KEY]:.4f}. Now it should be:\n{KEY}: {factor:.4f}')


if __name__ == '__main__':
    with exit_status():
        try:
            calibrate()
        except rospy.ROSInterruptException:
            rospy.loginfo('Calibration terminated.')
            sys.exit(130)
