#!/usr/bin/env python3
"""Shows the robot, its paths and speeds, and the log in a browser; starts runs, drives by hand, and stops the robot.

usage: web_view.py [_parameter:=value ...] [topic:=new_topic ...]      usually started by web_view.launch, or web:=true

Prints the address to open. It contains the token that is needed to move the robot. docs/web_view.md describes the page.
"""
import rbx1_nav.ros.node.early_interrupt     # first, so that Ctrl-C during the other imports exits quietly

import os
import sys
import threading
import time

import rospy
from rospy.names import get_resolved_mappings

from rbx1_nav.config import ConfigError
from rbx1_nav.ros.node import life, resources
from rbx1_nav.ros.node.params import param
from rbx1_nav.ros.web.checks import TOKEN_VARIABLE, HostCheck, machine_names, make_token, page_address
from rbx1_nav.ros.web.connections import Connections
from rbx1_nav.ros.web.controls import Controls
from rbx1_nav.ros.web.hand_drive import HandDrive
from rbx1_nav.ros.web.parameters import PARAMETERS
from rbx1_nav.ros.web.runs import Runs
from rbx1_nav.ros.web.server import Server
from rbx1_nav.ros.web.state import State
from rbx1_nav.ros.web.system import System
from rbx1_nav.ros.web.topics import CommandPublisher


def in_background(function):
    """Call a function in another thread, because a service call may block."""
    threading.Thread(target=function, daemon=True).start()


def remappings():
    """Return the remappings of this node, for the scripts that the page starts; without __name and the like."""
    return {name: new for name, new in get_resolved_mappings().items() if not name.startswith('__')}


class RobotView:
    """The view of one robot."""

    def __init__(self, name, token):
        """name: namespace of the robot, '' for that of this node; token: needed to move the robot."""
        namespace = f'/{name}/' if name else ''
        self.state, publisher = State(), CommandPublisher(namespace)
        self.state.set_status(title=param('title'), robots=robot_names(), spacing=param('spacing'))
        self.hand, self.system = HandDrive(publisher), System(self.state, publisher.connected, namespace)
        self.runs = Runs(os.path.dirname(os.path.abspath(sys.argv[0])),
                         lambda name, outcome: self.state.set_status(started=name, outcome=outcome),
                         self.system.forget_frame, remappings(), namespace)
        controls = Controls(self.state, self.system, self.hand, self.runs,
                            (param('linear_speed'), param('angular_speed')), in_background, log=rospy.loginfo,
                            stop_needs_token=param('stop_needs_token'))
        self.connections = Connections(self.state, controls, token, time.monotonic)

    def start(self):
        """Start the threads."""
        self.hand.start()
        self.system.start()

    def stop(self):
        """Stop what the page has started."""
        self.runs.stop()
        self.hand.end()


def robot_names():
    """Return the names of the robots of a fleet; [''] for one robot in the namespace of this node."""
    return [f'robot{number}' for number in range(1, round(param('robots')) + 1)] or ['']


def main():
    """Serve the page until the node shuts down; return the exit status."""
    # the page takes its time from the odometry, so the node need not read /clock
    life.init_node('web_view', __doc__, PARAMETERS, wall_time=True)
    address, token = param('address'), os.environ.get(TOKEN_VARIABLE) or make_token()
    views = {f'/socket/{name}': RobotView(name, token) for name in robot_names()}
    views['/socket'] = next(iter(views.values()))
    try:
        server = Server(resources.path('web'), HostCheck(address, machine_names()),
                        {path: view.connections for path, view in views.items()}, address, param('port'))
    except (ConfigError, OSError) as error:
        rospy.logfatal('address %s, port %s: %s: expected an address of this machine and a free port', address,
                       param('port'), error)
        return 1
    for view in set(views.values()):
        view.start()
    server.start()
    # printed instead of logged, because everyone who can reach the master can read the log
    print(f'[INFO] [{time.time():.6f}]: Open {page_address(address, server.port, token)}')
    life.end_requested.wait()
    for view in set(views.values()):
        view.stop()
    server.stop()
    return 0


if __name__ == '__main__':
    life.run(main)
