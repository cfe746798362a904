#!/usr/bin/env python3
"""Calibrates the odometry distance: drives until the odometry reports 1 m, and asks for the true distance.

usage: calibrate_linear.py [_parameter:=value ...] [topic:=new_topic ...]
example: rosrun rbx1_nav calibrate_linear.py _goal_distance:=2

Put a tape measure on the floor with its zero at a mark on the robot. The odometry should report the distance that you
measure. If the true distance is shorter than the reported one, the factor decreases.
"""
from __future__ import annotations

from rbx1_nav.driving import Drive

from math import hypot

import rospy

from rbx1_nav.base.calibration_factors import corrected, read_measured
from rbx1_nav.driving.calibration_script import COMMON, Diagnosis, ask, drive, factor_set, make_publisher
from rbx1_nav.driving.odometry import PoseListener
from rbx1_nav.driving.script import start_node
from rbx1_nav.exercise.legs import Straight
from rbx1_nav.node.parameters import number
from rbx1_nav.node.private_parameters import param

KEY = 'odom_linear_scale_correction'

PARAMETERS = [
    number('goal_distance', 1.0, 'm', 'distance to drive', 0.1, 100),
    number('linear_speed', 0.15, 'm/s', 'forward speed'),
    number('min_linear_speed', 0.05, 'm/s', 'lowest speed near the goal'),
    *COMMON]


def measure() -> tuple[float, float]:
    """Drive once; return the distance that the odometry reported (m) and the factor in force."""
    rate, linear_speed = param('rate'), param('linear_speed')
    leg = Straight('forward', param('goal_distance'), linear_speed, param('min_linear_speed'), rate)
    poses = PoseListener(param('odom_frame'), param('base_frame'), linear_speed, 0.0)
    base = Diagnosis(param('base_node'), 'Base')
    cmd_vel = make_publisher()
    with Drive(cmd_vel, timed=False):
        factor = factor_set(param('base_node'), KEY)
        drive(leg, poses, cmd_vel, rate)
    # A tape measures from mark to mark, not along the robot's initial heading.
    return hypot(leg.last.x - leg.start.x, leg.last.y - leg.start.y), float(base.value(KEY) or factor)


def calibrate() -> None:
    """Drive, ask, and print the factor."""
    start_node('calibrate_linear', __doc__, PARAMETERS)
    reported, before = measure()
    print(f'The odometry reports {reported:.3f} m.')
    measured = ask('How far is the robot from its start, in m?',
                   lambda answer: read_measured('measured', answer, reported, 'a distance', 'm'))
    if measured is None:
        print(f'{KEY}: {before:.4f} * METERS / {reported:.3f}, where METERS is how far the robot is from its start')
        return
    factor = corrected(KEY, before, measured, reported)
    print(f'The factor was {before:.4f}. Now it should be:\n{KEY}: {factor:.4f}')


if __name__ == '__main__':
    try:
        calibrate()
    except rospy.ROSInterruptException:
        rospy.loginfo('Calibration terminated.')
