#!/usr/bin/env python3
"""Calibrates wheels and gyro: turns the robot until its odometry reports 360 degrees, and asks for the true angle.

usage: calibrate_angular.py [_parameter:=value ...] [topic:=new_topic ...]
example: rosrun rbx1_nav calibrate_angular.py _turns:=3

Mark the robot's heading on the floor. When the robot faces the mark again, it has turned 360 degrees; when it is 10
degrees short of the mark, it has turned 350 degrees. The gyro is calibrated on the same turn.
"""
from __future__ import annotations

from rbx1_nav.driving import Drive

from math import degrees, pi

import rospy
from sensor_msgs.msg import Imu

from rbx1_nav.base.calibration_factors import corrected, read_measured, turn_by_gyro
from rbx1_nav.base.units import wrap_angle
from rbx1_nav.driving.calibration_script import COMMON, Diagnosis, ask, drive, factor_set, make_publisher
from rbx1_nav.driving.odometry import PoseListener
from rbx1_nav.driving.script import start_node
from rbx1_nav.exercise.legs import Turn
from rbx1_nav.extras.create.angle_fractions import MEASURED, TEST
from rbx1_nav.node.config import ConfigError
from rbx1_nav.node.parameters import number
from rbx1_nav.node.private_parameters import param

ODOM_KEY, GYRO_KEY = 'odom_angular_scale_correction', 'gyro_scale_correction'
MOVED = 1.0     # degrees, by which a robot has turned that is not at rest

PARAMETERS = [
    number('turns', 1, '', 'number of full turns to the left', 0.1, 100),
    number('angular_speed', 0.5, 'rad/s', 'turning speed'),
    number('min_angular_speed', 0.2, 'rad/s', 'lowest speed near the goal'),
    *COMMON]


def measure() -> tuple[dict[str, float], str]:
    """Turn once; return the angles that odometry and gyro reported (degrees) with the factors in force, and whether the
    robot loses fractions of a degree, according to the base."""
    rate, angular_speed = param('rate'), param('angular_speed')
    leg = Turn('turn left', 2 * pi * param('turns'), angular_speed, param('min_angular_speed'), rate)
    base_node = param('base_node')
    poses = PoseListener(param('odom_frame'), param('base_frame'), 0.0, angular_speed)
    readings: list[tuple[float, float]] = []    # of the gyro: s, rad/s
    base, gyro = Diagnosis(base_node, 'Base'), Diagnosis(base_node, 'Gyro')
    cmd_vel = make_publisher()
    with Drive(cmd_vel, timed=False):
        first = poses.pose()
        run = {key: factor_set(base_node, key) for key in (ODOM_KEY, GYRO_KEY)}
        # The gyro reports its bias while the robot is stationary.
        rospy.Subscriber('imu/data', Imu, lambda message: readings.append((message.header.stamp.to_sec(),
                                                                           message.angular_velocity.z)))
        rospy.sleep(2)
        # on the clock of the gyro, which may differ from this node's
        begin, start = rospy.get_time(), readings[-1][0] if readings else 0.0
        drive(leg, poses, cmd_vel, rate)
        end = start + rospy.get_time() - begin
    run[ODOM_KEY] = float(base.value(ODOM_KEY) or run[ODOM_KEY])
    # a Create without a gyro does not use the gyro's factor
    run[GYRO_KEY] = float(gyro.value(GYRO_KEY) or (1 if base.last else run[GYRO_KEY]))
    run['reported'] = degrees(leg.done())
    try:
        if gyro.error:
            raise ConfigError(f'the base reports an error: {gyro.error}')
        moved = degrees(abs(wrap_angle(leg.start.yaw - first.yaw)))
        if moved > MOVED:
            raise ConfigError(f'the robot turned by {moved:.1f} degrees before the turn: expected a robot at rest')
        if not readings:
            raise ConfigError(f"no messages on {rospy.resolve_name('imu/data')}")
        run['gyro'] = degrees(turn_by_gyro(list(readings), start, end, leg.done()))
    except ConfigError as error:
        warn_of_gyro(error)
    return run, base.value('Fractions of a degree') or ''


def warn_of_gyro(error: ConfigError) -> None:
    """Log why the gyro is not calibrated."""
    rospy.logwarn('The gyro is not calibrated: %s. See /diagnostics of the base', error)


def calibrate() -> None:
    """Turn, ask, and print the factors."""
    start_node('calibrate_angular', __doc__, PARAMETERS)
    run, fractions = measure()
    print(f"The odometry reports {run['reported']:.1f} degrees.")
    if 'gyro' in run:
        print(f"The gyro reports {run['gyro']:.1f} degrees.")
    true_value = ask('How far has the robot turned, in degrees?',
                     lambda answer: read_measured('measured', answer, run['reported'], 'an angle', 'degrees'))
    if true_value is None:
        for key, value in {ODOM_KEY: 'reported', GYRO_KEY: 'gyro'}.items():
            if value in run:
                print(f'{key}: {run[key]:.4f} * DEGREES / {run[value]:.1f}, where DEGREES is how far the robot has '
                      'turned')
        return
    factors = {ODOM_KEY: corrected(ODOM_KEY, run[ODOM_KEY], true_value, run['reported'])}
    if 'gyro' in run:
        try:
            factors[GYRO_KEY] = corrected(GYRO_KEY, run[GYRO_KEY], true_value, run['gyro'])
        except ConfigError as error:
            warn_of_gyro(error)
    before = ', '.join(f'{run[key]:.4f}' for key in factors)
    print(f'The factors were {before}. Now they should be:' if len(factors) > 1 else
          f'The factor was {before}. Now it should be:')
    for key, factor in factors.items():
        print(f'{key}: {factor:.4f}')
    if fractions.startswith(MEASURED):
        print(f'angle_fractions: {fractions[len(MEASURED):]}')
        print('Set angle_fractions first, restart the base, and calibrate again: these factors are less exact.')
    elif fractions == TEST:
        print('angle_fractions: not known yet: expected a slower turn, with _angular_speed:=0.3')


if __name__ == '__main__':
    try:
        calibrate()
    except rospy.ROSInterruptException:
        rospy.loginfo('Calibration terminated.')
