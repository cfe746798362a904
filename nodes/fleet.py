#!/usr/bin/env python3
"""Simulates several bases in one process, in real time or on one simulated clock; each robot has its own namespace.

usage: fleet.py [_parameter:=value ...]      usually started by fleet.launch

Robots can be added and removed while others drive: rosservice call /fleet/add robot6
"""
from __future__ import annotations

import rbx1_nav.node.early_interrupt     # first, so that Ctrl-C during the other imports exits quietly

from concurrent.futures import Future
from functools import partial
import queue
import re
from typing import Callable, Tuple

from diagnostic_msgs.srv import AddDiagnostics, AddDiagnosticsResponse
from geometry_msgs.msg import TransformStamped
import rospy
from tf2_msgs.msg import TFMessage

from rbx1_nav.base import messages
from rbx1_nav.base.clocks import Clock
from rbx1_nav.base.kinematics import Pose
from rbx1_nav.base.publisher import with_frames
from rbx1_nav.base.robot_parameters import DRIVER_KEYS, PARAMETERS as ROBOT, read_robot
from rbx1_nav.base.refusals import Refusals
from rbx1_nav.base.schedule import Schedule
from rbx1_nav.exercise.methods import METHODS
from rbx1_nav.extras.lockstep.simulated_clock import PARAMETERS as CLOCK, read_clock
from rbx1_nav.node import life
from rbx1_nav.node.config import ConfigError, Section
from rbx1_nav.node.master import is_alive
from rbx1_nav.node.parameters import choice, number
from rbx1_nav.node.private_parameters import param
from rbx1_nav.node.tf_prefix import with_prefix
from rbx1_nav.simulation.floor_parameters import read_floor
from rbx1_nav.simulation.simulated_base_node import SimulatedRobot

PARAMETERS = [
    number('robots', 0, '', 'number of robots at the beginning: robot1, robot2 and so on', 0, 200, 'a number'),
    number('spacing', 1.0, 'm', 'distance between neighbors in the frame map', 0, 1000, 'a distance'),
    choice('method', ('none', *(each.name for each in METHODS.values() if not each.filtered)), 'none',
           'script that fleet.launch starts for each robot'),
    number('rate', 50.0, 'Hz', 'rate at which the bases are updated; odometry at most', 1, 1000, 'a rate'),
    *CLOCK]
Result = Tuple[bool, str]   # whether something was possible, and a text


class Fleet:
    """All robots. They are added and removed by the thread that runs the clock, between two ticks."""

    def __init__(self, clock: Clock) -> None:
        self.clock = clock
        self.refusals = Refusals()
        self.robots: dict[str, tuple[SimulatedRobot, Schedule]] = {}    # by name
        # (function, name, Future for its result)
        self.requests: queue.Queue[tuple[Callable[[str], Result], str, Future[Result]]] = queue.Queue()
        # transforms from map to the odometry of each robot, also of those that were removed
        self.places: list[TransformStamped] = []
        self.place_pub = rospy.Publisher('/tf_static', TFMessage, latch=True, queue_size=1)

    def serve(self) -> None:
        """Offer the services. The request is AddDiagnostics, which has one text: the name of the robot."""
        for name in 'add', 'remove':
            rospy.Service(f'~{name}', AddDiagnostics, lambda request, name=name: AddDiagnosticsResponse(
                *self.request(getattr(self, name), request.load_namespace.strip('/'))))

    def request(self, function: Callable[[str], Result], name: str) -> Result:
        """Let the thread of the clock call a function; return whether this was possible, and a text."""
        done: Future[Result] = Future()
        self.requests.put((function, name, done))
        while not (done.done() or life.end_requested.is_set()):
            life.sleep(0.001)
        return done.result() if done.done() else (False, 'the node is shutting down')

    def add(self, name: str) -> Result:
        """Add a robot with the parameters below NAME/arbotix; return whether this was possible, and a text."""
        key = f'/{name}/arbotix'
        try:
            if name in self.robots:
                raise ConfigError('this robot exists: expected a new name')
            if not re.fullmatch(r'[A-Za-z]\w{0,49}', name, re.ASCII):
                raise ConfigError('expected the name of a robot: letters, digits and _')
            if is_alive(key):
                raise ConfigError('expected the name of a robot that is not simulated by another node')
            params = rospy.get_param(key, None)
            if not params:
                raise ConfigError('no parameters: expected those of a base, see docs/several_robots.md')
            section = Section(params, hardware={*DRIVER_KEYS, 'diagnostic_period', *(each.name for each in ROBOT)})
            robot, floor = read_robot(params), read_floor(section)
        except ConfigError as error:
            text = f'{key}: {error}'
            rospy.logerr('%s', text)
            return False, text
        robot = with_frames(robot._replace(unknown=[*robot.unknown, *section.unknown()]), partial(with_prefix, name))
        simulated = SimulatedRobot(robot, *floor, self.clock, self.refusals, name)
        simulated.start()
        self.robots[name] = simulated, Schedule(robot.rate)
        self.place(robot.odom_frame_id)
        return True, f'{name}: added'

    def place(self, frame: str) -> None:
        """Publish where in the frame map the odometry of a new robot begins: to the right of the one before."""
        pose = Pose(0.0, -param('spacing') * len(self.places), 0.0)
        self.places.append(messages.transform(rospy.Time(), 'map', frame, pose))
        self.place_pub.publish(TFMessage(self.places))

    def remove(self, name: str) -> Result:
        """Remove a robot; return whether there was one of this name, and a text."""
        if name not in self.robots:
            return False, f"{name}: expected one of {', '.join(self.robots) or 'no robots'}"
        robot, _ = self.robots.pop(name)
        robot.close()
        rospy.loginfo('%s: removed', name)
        return True, f'{name}: removed'

    def step(self) -> None:
        """Do what was requested, and publish the state of each robot."""
        while not self.requests.empty():
            function, name, done = self.requests.get()
            try:
                done.set_result(function(name))
            except (OSError, rospy.ROSException) as error:      # of the master
                done.set_result((False, f'{name}: {error}'))
        for robot, schedule in self.robots.values():
            if schedule.due(self.clock.now()):
                robot.step()


def main() -> int:
    """Run the fleet; return the exit status."""
    life.init_node('fleet', __doc__, PARAMETERS)
    fleet = Fleet(read_clock(param('rate')))
    if not all(fleet.add(f'robot{number}')[0] for number in range(1, round(param('robots')) + 1)):
        return 1
    fleet.serve()
    rospy.loginfo('Ready: %d robots', len(fleet.robots))
    fleet.clock.run(fleet.step)
    return 0


if __name__ == '__main__':
    life.run(main)
