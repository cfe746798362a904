#!/usr/bin/env python3
"""Calibrates the turn that wheels and gyro report: turns 360 degrees by odometry, asks how far it really was.

usage: calibrate_angular.py [_parameter:=value ...] [topic:=new_topic ...]
example: rosrun rbx1_nav calibrate_angular.py _turns:=3

Parameters:
    ~turns              how many full turns to the left (default: 1)
    ~angular_speed      turning speed, rad/s (default: 0.5)
    ~min_angular_speed  lowest speed near the goal, rad/s (default: 0.2)
    ~rate               commands per second, Hz (default: 50)
    ~odom_frame         frame of the odometry (default: odom)
    ~base_frame         frame of the robot (default: base_footprint or base_link, whichever exists)
    ~base_node          node whose parameters are calibrated (default: turtlebot_node)
    ~wait_timeout       how long to wait for roscore, for a base, and for its pose, s (default: 30)
    ~measured           how far the robot turned in the last run, degrees: in place of an answer; does not drive

Mark on the floor where the robot points to. Facing the mark again it has turned by 360 degrees; 10 degrees before it,
by 350. The gyro is compared with the same turn.
"""
import rbx1_nav.ros.node.early_interrupt     # Ctrl-C ends the node quietly even while the rest is loaded

from math import degrees, pi

import rospy
from sensor_msgs.msg import Imu

from rbx1_nav.config import ConfigError
from rbx1_nav.control.legs import Turn
from rbx1_nav.create.driver.fractions import LOST
from rbx1_nav.create.driver.parameters import GYRO_CORRECTION
from rbx1_nav.robot.calibration import corrected, read_measured, turn_by_gyro
from rbx1_nav.ros.node import life
from rbx1_nav.ros.driving.calibration import (
    Diagnosis, factor_in_force, forget_run, load_run, node_param, save_run, take_measured)
from rbx1_nav.ros.driving.leg_driver import LegDriver
from rbx1_nav.ros.node.params import frame_param, positive_param
from rbx1_nav.ros.node.question import ask

ODOM_KEY, GYRO_KEY = 'odom_angular_scale_correction', 'gyro_scale_correction'


def drive():
    """Turn once. Returns what odometry and gyro reported, degrees, and the factors with which they did."""
    rate = positive_param('rate', 50, 2, 1000)                          # Hz
    angular_speed = positive_param('angular_speed', 0.5)                # rad/s
    leg = Turn('turn left',
               2 * pi * positive_param('turns', 1, 0.1, 100),           # rad
               angular_speed,
               positive_param('min_angular_speed', 0.2),                # rad/s
               rate)
    wait_timeout = positive_param('wait_timeout', 30)                   # s
    base_node = node_param('base_node', 'turtlebot_node')
    driver = LegDriver(frame_param('odom_frame', 'odom'), frame_param('base_frame', None), 0.0, angular_speed, rate)
    readings = []       # of the gyro: (s, rad/s)
    rospy.Subscriber('imu/data', Imu, lambda message: readings.append((message.header.stamp.to_sec(),
                                                                       message.angular_velocity.z)))
    base, gyro = Diagnosis(base_node, 'Base'), Diagnosis(base_node, 'Gyro')
    forget_run('angular')
    try:
        driver.wait_for_base(wait_timeout)
        run = {ODOM_KEY: factor_in_force(base_node, ODOM_KEY), GYRO_KEY: factor_in_force(base_node, GYRO_KEY, None)}
        # What the gyro reports at rest is its bias.
        driver.rest(2)
        start = rospy.get_time()
        driver.drive(leg)
        end = rospy.get_time()
    finally:
        # However it ended: the most important thing that a mobile robot must do.
        driver.stop()
    run['reported'] = degrees(leg.done())
    if run[GYRO_KEY] is None:   # the default of a Create's base
        run[GYRO_KEY] = GYRO_CORRECTION if gyro.last else 1.0
    try:
        if gyro.error:
            raise ConfigError(f'the base reports an error: {gyro.error}')
        if not readings:
            raise ConfigError(f"nothing arrives on {rospy.resolve_name('imu/data')}")
        run['gyro'] = degrees(turn_by_gyro(list(readings), start, end, leg.done()))
    except ConfigError as error:
        warn_of_gyro(error)
    run['loses_fractions'] = int(base.value('Fractions of a degree') == LOST)
    return run


def warn_of_gyro(error):
    """Log why the gyro is not calibrated."""
    rospy.logwarn('The gyro is not calibrated: %s. See /diagnostics of the base', error)


def calibrate():
    """Turn, ask, and print the factors."""
    life.init_node('calibrate_angular', __doc__)
    measured = take_measured()
    if measured is None:
        run = drive()
        save_run('angular', run)
    else:
        run = load_run('angular', 'reported', 'loses_fractions', ODOM_KEY, GYRO_KEY)
    print(f"The odometry reports {run['reported']:.1f} degrees.")
    if run['loses_fractions']:
        print('The robot loses fractions of a degree. The base noticed it in a turn, and now corrects its odometry. With '
              'the line angle_fractions in your file, it does so from the start.')
    if 'gyro' in run:
        print(f"The gyro reports {run['gyro']:.1f} degrees.")

    def check(answer):
        return read_measured('measured', answer, run['reported'], 'an angle', 'degrees')

    measured = ask('How far has the robot turned, in degrees?', check) if measured is None else check(measured)
    if measured is None:
        print('Measure how far the robot has turned, in degrees. Then: rosrun rbx1_nav calibrate_angular.py '
              '_measured:=DEGREES')
        return
    factors = {ODOM_KEY: corrected(ODOM_KEY, run[ODOM_KEY], measured, run['reported'])}
    if 'gyro' in run:
        try:
            factors[GYRO_KEY] = corrected(GYRO_KEY, run[GYRO_KEY], measured, run['gyro'])
        except ConfigError as error:
            warn_of_gyro(error)
    print('The %s %s. Now %s should be:' % ('factors were' if len(factors) > 1 else 'factor was', ', '.join(
        '%.4f' % run[key] for key in factors), 'they' if len(factors) > 1 else 'it'))
    for key, factor in factors.items():
        print(f'{key}: {factor:.4f}')
    if run['loses_fractions']:
        print(f'angle_fractions: {LOST}')


if __name__ == '__main__':
    status = 0
    try:
        calibrate()
    except rospy.ROSInterruptException:
        rospy.loginfo('Calibration terminated.')
        status = 130
    except (rospy.ROSException, ValueError, OSError) as error:    # OSError: the master does not answer
        rospy.logerr('%s', error)
        status = 1
    life.leave(status)
