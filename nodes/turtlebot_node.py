#!/usr/bin/env python3
"""Drives a TurtleBot's base, an iRobot Create or Create 2, over a serial port: cmd_vel in, odom out.

usage: turtlebot_node.py [_parameter:=value ...] [topic:=new_topic ...]  started by turtlebot_minimal_create.launch

The parameters are named as in create_node.
"""
from __future__ import annotations

import rbx1_nav.node.early_interrupt     # first, so that Ctrl-C during the other imports exits quietly

import rospy

from rbx1_nav.base.model_check import ModelCheck
from rbx1_nav.base.publisher import with_frames
from rbx1_nav.extras.create.create_base import CreateBase
from rbx1_nav.extras.create.create_parameters import PARAMETERS, read_settings
from rbx1_nav.node import life
from rbx1_nav.node.private_parameters import stored_params
from rbx1_nav.node.tf_prefix import resolve_frame


def main() -> int:
    """Read the parameters and run; return the exit status."""
    life.init_node('turtlebot_node', __doc__, PARAMETERS, check=read_settings)
    if not rospy.rostime.is_wallclock():
        rospy.logfatal('/use_sim_time: true: expected false, because a robot on a serial line runs in real time')
        return 1
    settings, robot = read_settings(stored_params())
    base = CreateBase(settings, with_frames(robot, resolve_frame))
    ModelCheck(base.publisher, ('base_frame', ''), base.diagnostics.updater).start()
    return 0 if base.run() else 1


if __name__ == '__main__':
    life.run(main)
