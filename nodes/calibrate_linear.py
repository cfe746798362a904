#!/usr/bin/env python3
"""Calibrates the odometry distance: drives until the odometry reports 1 m, and asks for the true distance.

usage: calibrate_linear.py [_parameter:=value ...] [topic:=new_topic ...]
example: rosrun rbx1_nav calibrate_linear.py _goal_distance:=2

Put a tape measure on the floor with its zero at a mark on the robot. The odometry should report the distance that you
measure. If the true distance is shorter than the reported one, the factor decreases.
"""
from __future__ import annotations

from rbx1_nav.ros.driving.script import exit_status, init_node, number, param

from math import hypot
import sys

import rospy

from rbx1_nav.config import YamlValue
from rbx1_nav.control.legs import Straight
from rbx1_nav.parameters import elsewhere
from rbx1_nav.robot.calibration import corrected, read_measured
from rbx1_nav.ros.driving.calibrating import (
    COMMON, CalibrationDrive, ask, factor_in_force, forget_run, load_run, save_run, take_measured)
from rbx1_nav.ros.driving.pose_listener import PoseListener

KEY = 'odom_linear_scale_correction'

PARAMETERS = [
    number('goal_distance', 1.0, 'm', 'distance to drive', 0.1, 100),
    number('linear_speed', 0.15, 'm/s', 'forward speed'),
    number('min_linear_speed', 0.05, 'm/s', 'lowest speed near the goal'),
    *COMMON,
    elsewhere('measured', 'true distance of the last run, given instead of an answer; the robot does not move',
              unit='m', note='from half to twice the reported distance')]


def measure() -> dict[str, float]:
    """Drive once; return the distance that the odometry reported (m) and the factor in force."""
    rate, linear_speed = param('rate'), param('linear_speed')
    leg = Straight('forward', param('goal_distance'), linear_speed, param('min_linear_speed'), rate)
    base_node = param('base_node')
    poses = PoseListener(param('odom_frame'), param('base_frame'), linear_speed, 0.0)
    forget_run('linear')
    with CalibrationDrive(rate, poses) as drive:
        factor = factor_in_force(base_node, KEY, 1.0)
        drive.drive(leg)
    # A tape measures from mark to mark, not along the robot's initial heading.
    return {'reported': hypot(leg.last.x - leg.start.x, leg.last.y - leg.start.y), KEY: factor}


def calibrate() -> None:
    """Drive, ask, and print the factor."""
    init_node('calibrate_linear', __doc__, PARAMETERS)
    measured = take_measured()
    if measured is None:
        run = measure()
        save_run('linear', run)
    else:
        run = load_run('linear', 'reported', KEY)
    print(f"The odometry reports {run['reported']:.3f} m.")

    def check(answer: YamlValue) -> float:
        return read_measured('measured', answer, run['reported'], 'a distance', 'm')

    true_value = ask('How far is the robot from its start, in m?', check) if measured is None else check(measured)
    if true_value is None:
        print('Measure how far the robot is from its start, in m. Then: rosrun rbx1_nav calibrate_linear.py '
              '_measured:=METERS')
        return
    factor = corrected(KEY, run[KEY], true_value, run['reported'])
    print(f'The factor was {run[KEY]:.4f}. Now it should be:\n{KEY}: {factor:.4f}')


if __name__ == '__main__':
    with exit_status():
        try:
            calibrate()
        except rospy.ROSInterruptException:
            rospy.loginfo('Calibration terminated.')
            sys.exit(130)
