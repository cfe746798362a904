#!/usr/bin/env python3
"""The base of a TurtleBot: drives an iRobot Create or Create 2 over a serial port. cmd_vel in, odom out.

usage: turtlebot_node.py [_parameter:=value ...] [topic:=new_topic ...]  started by turtlebot_minimal_create.launch

Parameters, with the names of create_node's:
    ~port                           the serial port (default: /dev/ttyUSB0)
    ~robot_type                     create, create2, or auto: whichever answers (default: auto)
    ~baud                           rate of the line, bits per second, or auto (default: auto)
    ~update_rate                    of sensors and odometry, Hz (default: 30)
    ~operation_mode                 2: safe; 3: full, without the robot's cliff and wheel-drop stop; 1: passive, the
                                    robot is not driven (default: 2)
    ~oi_mode_workaround             whether the robot reports its mode plus one, as some Roombas do: true, false, or
    auto
                                    (default: auto)
    ~wake_robot                     whether to wake a robot that does not answer by RTS and DTR (default: false)
    ~cmd_vel_timeout                a command of this age stops the robot, s (default: 0.6)
    ~stop_motors_on_bump            whether a bump stops forward motion (default: true)
    ~min_abs_yaw_vel                slower turns are commanded at this speed, rad/s (default: 0)
    ~max_abs_yaw_vel                faster turns are limited to this speed, rad/s; 0: no limit (default: 0)
    ~has_gyro                       whether there is a gyro at the analog input (default: true; create2: false)
    ~gyro_measurement_range         of the gyro's chip, degrees/s (default: 150)
    ~gyro_scale_correction          factor for the gyro's angular velocity (default: 1.35)
    ~odom_linear_scale_correction   factor for the distance that the robot reports (default: 1)
    ~odom_angular_scale_correction  factor for the angle (default: 1)
    ~angle_fractions                what the robot does with fractions of a degree: kept, lost, or auto (default: auto)
    ~odom_linear_error              error of the distance, 1 sigma, m after 1 m (default: 0.05)
    ~odom_angular_error             error of the angle, 1 sigma, rad after 1 rad (default: 0.09)
    ~odom_heading_error             error of the heading, 1 sigma, rad after 1 m (default: 0.07)
    ~moving_yaw_variance            variance of the heading while the robot moves, rad^2, in place of the calculated
    one, as
                                    create_node has it: 1000; 0: none (default: 0)
    ~odom_frame, ~base_frame        frames (default: odom, base_footprint)
    ~left_wheel, ~right_wheel       names of the wheels' joints (default: base_l_wheel_joint, base_r_wheel_joint)
    ~publish_tf                     whether to publish the transform to the base frame (default: true)
    ~drive_mode, ~diagnostic_period accepted: twist, and any number; /diagnostics has 1 Hz
"""
import rbx1_nav.ros.node.early_interrupt     # Ctrl-C ends the node quietly even while the rest is loaded

import rospy

from rbx1_nav.config import ConfigError
from rbx1_nav.create.driver.parameters import read_settings
from rbx1_nav.ros.base.create_base import CreateBase
from rbx1_nav.ros.node import life


def main():
    """Read the parameters, and run. Returns the exit status."""
    life.init_node('turtlebot_node', __doc__, check=read_settings)
    if not rospy.rostime.is_wallclock():
        rospy.logfatal('/use_sim_time: true: expected false, a robot on a serial line runs in real time')
        return 1
    try:
        settings, robot = read_settings(rospy.get_param(rospy.get_name(), {}))
    except ConfigError as error:
        rospy.logfatal('%s/%s', rospy.get_name(), error)
        return 1
    return 0 if CreateBase(settings, robot).run() else 1


if __name__ == '__main__':
    life.run(main)
