#!/usr/bin/env python3
"""Shows the robot, its paths and speeds, and the log in a browser; starts runs, drives by hand, and stops the robot.

usage: web_view.py [_parameter:=value ...] [topic:=new_topic ...]      usually started by web_view.launch, or web:=true

Prints the address to open. Whoever opens it first may move the robot. docs/web_view.md describes the page.
"""
from __future__ import annotations

import rbx1_nav.node.early_interrupt     # first, so that Ctrl-C during the other imports exits quietly

from functools import partial
import os
import sys
import threading
import time
from typing import Callable

import rospy
from rospy.names import get_resolved_mappings

from rbx1_nav.extras.web.access import (
    CODE_VARIABLE, LOCALHOST, TEACHER_VARIABLE, TOKEN_VARIABLE, Access, make_token, page_address)
from rbx1_nav.extras.web.choices import CHOICES, read_choices
from rbx1_nav.extras.web.connections import Connections
from rbx1_nav.extras.web.controls import Controls
from rbx1_nav.extras.web.hand_drive import HandDrive, command_publisher
from rbx1_nav.extras.web.page_runs import Runs
from rbx1_nav.extras.web.server import PageServer
from rbx1_nav.extras.web.state import PageState
from rbx1_nav.extras.web.system import System
from rbx1_nav.node import life, resources
from rbx1_nav.node.config import ConfigError, YamlValue, show
from rbx1_nav.node.parameters import custom, flag, number
from rbx1_nav.node.private_parameters import param


MAX_TEXT = 60


def check_text(name: str, value: YamlValue) -> str:
    """Return the value of a parameter that is a text. Raises ConfigError."""
    if isinstance(value, str) and 0 < len(value) <= MAX_TEXT:
        return value
    raise ConfigError(f'{name}: {show(value)}: expected a text of 1 to {MAX_TEXT} characters')


PARAMETERS = [
    custom('address', LOCALHOST, 'address at which the page is served; localhost: for this machine only',
           partial(check_text, 'address'),
           note='0.0.0.0: all addresses of this machine; see [Security](web_view.md#security)'),
    number('port', 8080, '', 'TCP port at which the page is served; 0: any free port', 0, 65535, 'a TCP port'),
    number('robots', 0, '', 'number of robots of a fleet; 0: the robot in the namespace of this node', 0, 20),
    number('spacing', 1.0, 'm', 'distance between the starts of neighbors in a fleet', 0, 1000, 'a distance'),
    custom('title', 'Out and back', 'title of the page', partial(check_text, 'title')),
    custom('choices', ','.join(CHOICES), 'what can be chosen in the page for a simulated robot', read_choices,
           note='none, or some of the default'),
    flag('stop_needs_token', False, 'whether Stop needs the token, for a machine that is shared with strangers'),
    number('linear_speed', 0.2, 'm/s', 'speed while an arrow key drives forward or backward', 0.01, 1),
    number('angular_speed', 1.0, 'rad/s', 'speed while an arrow key turns the robot', 0.01, 4)]


def in_background(function: Callable[[], None]) -> None:
    """Call a function in another thread, because a service call may block."""
    threading.Thread(target=function, daemon=True).start()


def remappings() -> dict[str, str]:
    """Return the remappings of this node, for the scripts that the page starts; without __name and the like."""
    return {name: new for name, new in get_resolved_mappings().items() if not name.startswith('__')}


class RobotView:
    """The view of one robot."""

    def __init__(self, name: str, access: Access) -> None:
        """name: namespace of the robot, '' for the namespace of this node; access: who may move the robot."""
        namespace = f'/{name}/' if name else ''
        self.state = PageState()
        self.state.set_status(title=param('title'), robots=robot_names(), spacing=param('spacing'))
        self.hand = HandDrive(command_publisher(namespace))
        self.system = System(self.state, namespace, param('choices'))
        self.runs = Runs(os.path.dirname(os.path.abspath(sys.argv[0])),
                         lambda name, outcome: self.state.set_status(started=name, outcome=outcome),
                         self.system.forget_frame, remappings(), namespace)
        controls = Controls(self.state, self.system, self.hand, self.runs,
                            (param('linear_speed'), param('angular_speed')), in_background,
                            log=partial(rospy.loginfo_throttle, 5),
                            stop_needs_token=param('stop_needs_token'))
        self.connections = Connections(self.state, controls, access, time.monotonic)

    def start(self) -> None:
        """Start the threads."""
        self.hand.start()
        self.system.start()

    def stop(self) -> None:
        """Stop what the page has started."""
        self.runs.stop()
        self.hand.end()


def robot_names() -> list[str]:
    """Return the names of the robots of a fleet; [''] for one robot in the namespace of this node."""
    return [f'robot{number}' for number in range(1, round(param('robots')) + 1)] or ['']


def main() -> int:
    """Serve the page until the node shuts down; return the exit status."""
    # the page takes its time from the odometry, so the node need not read /clock
    life.init_node('web_view', __doc__, PARAMETERS, wall_time=True)
    address, token = param('address'), os.environ.get(TOKEN_VARIABLE)
    access = Access(token or make_token(), os.environ.get(CODE_VARIABLE, ''))
    views = {f'/socket/{name}': RobotView(name, access) for name in robot_names()}
    views['/socket'] = next(iter(views.values()))
    try:
        server = PageServer(resources.path('web'), {path: view.connections for path, view in views.items()}, address,
                            round(param('port')), teacher_port=int(os.environ.get(TEACHER_VARIABLE, 0)))
    except OSError as error:
        rospy.logfatal('address %s, port %g: %s: expected an address of this machine and a free port', address,
                       param('port'), error)
        return 1
    for view in set(views.values()):
        view.start()
    server.start()
    # printed instead of logged, because everyone who can reach the master can read the log
    page = page_address(address, server.port, '' if token else access.invite())
    print(f'[INFO] [{time.time():.6f}]: Open {page}')
    life.end_requested.wait()
    for view in set(views.values()):
        view.stop()
    server.stop()
    return 0


if __name__ == '__main__':
    life.run(main)
