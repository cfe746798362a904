#!/usr/bin/env python3
"""Simulates a differential-drive base, as a replacement for an ArbotiX base; cmd_vel in, odom out.

usage: fake_base.py [_parameter:=value ...] [topic:=new_topic ...]      usually started by fake_turtlebot.launch
"""
from __future__ import annotations

import rbx1_nav.node.early_interrupt     # first, so that Ctrl-C during the other imports exits quietly

from rbx1_nav.base.model_check import ModelCheck
from rbx1_nav.base.publisher import with_frames
from rbx1_nav.base.robot_parameters import DRIVER_KEYS, PARAMETERS as ROBOT, read_robot
from rbx1_nav.base.refusals import Refusals
from rbx1_nav.extras.lockstep.simulated_clock import PARAMETERS as CLOCK, read_clock
from rbx1_nav.node import life
from rbx1_nav.node.parameters import elsewhere
from rbx1_nav.node.private_parameters import param, stored_params
from rbx1_nav.node.tf_prefix import resolve_frame
from rbx1_nav.simulation.floor_parameters import FLOOR, ChosenFloor
from rbx1_nav.simulation.simulated_base_node import SimulatedRobot

PARAMETERS = [
    *ROBOT,
    *FLOOR,
    *CLOCK,
    *(elsewhere(name, 'ArbotiX parameter, accepted and ignored')
      for name in sorted({'diagnostic_period', *DRIVER_KEYS}))]


def main() -> int:
    """Read the configuration and run; return the exit status."""
    life.init_node('arbotix', __doc__, PARAMETERS, check=read_robot)
    robot = read_robot(stored_params())
    clock = read_clock(robot.rate)
    simulated = SimulatedRobot(with_frames(robot, resolve_frame), param('surface'), param('seed'), clock, Refusals(),
                               '', ChosenFloor(stored_params).changed)
    key = f'controllers/{robot.name}'
    ModelCheck(simulated.publisher, (f'{key}/base_frame_id', key), simulated.diagnostics).start()
    simulated.start()
    clock.run(simulated.step)
    return 0


if __name__ == '__main__':
    life.run(main)
