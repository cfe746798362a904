#!/usr/bin/env python3
"""Shows the exercise in a browser: floor, robot, paths, speeds, log; starts runs, drives by hand, and stops.

usage: web_view.py [_parameter:=value ...] [topic:=new_topic ...]      usually started by web_view.launch, or web:=true

Prints the address to open. What moves the robot needs the token in it. docs/web_view.md describes the page.
"""
import rbx1_nav.ros.node.early_interrupt     # Ctrl-C ends the node quietly even while the rest is loaded

import os
import sys
import threading
import time

import rospy

from rbx1_nav.config import ConfigError
from rbx1_nav.ros.node import life, resources
from rbx1_nav.ros.node.params import param
from rbx1_nav.ros.web.checks import HostCheck, is_wildcard, machine_names, make_token
from rbx1_nav.ros.web.connections import Connections
from rbx1_nav.ros.web.controls import Controls
from rbx1_nav.ros.web.hand_drive import HandDrive
from rbx1_nav.ros.web.parameters import LOCALHOST, PARAMETERS
from rbx1_nav.ros.web.runs import Runs
from rbx1_nav.ros.web.server import Server
from rbx1_nav.ros.web.state import State
from rbx1_nav.ros.web.system import System
from rbx1_nav.ros.web.topics import CommandPublisher


def in_background(function):
    """Call a function in another thread: a service may take long, and the server must not wait."""
    threading.Thread(target=function, daemon=True).start()


def url(address, port, token):
    """The address to open. The part behind # stays in the browser: it is in no request, and in no log of a proxy."""
    host = LOCALHOST if is_wildcard(address) else f'[{address}]' if ':' in address else address
    return f'http://{host}:{port}/#{token}'


def main():
    """Serve the page until the node is to end. Returns the exit status."""
    # the page has a time of its own, from the odometry: the node does not need each message on /clock
    life.init_node('web_view', __doc__, PARAMETERS, wall_time=True)
    state, hand, token, address = State(), HandDrive(CommandPublisher()), make_token(), param('address')
    system = System(state)
    runs = Runs(os.path.dirname(os.path.abspath(sys.argv[0])),
                lambda name, outcome: state.set_status(started=name, outcome=outcome), system.forget_frame)
    controls = Controls(state, system, hand, runs, (param('linear_speed'), param('angular_speed')), in_background)
    connections = Connections(state, controls, token, time.monotonic)
    try:
        server = Server(resources.path('web'), HostCheck(address, machine_names()), connections, address, param('port'))
    except (ConfigError, OSError) as error:
        rospy.logfatal('%s, %s: %s: expected an address of this machine and a port that is free', address,
                       param('port'), error)
        return 1
    hand.start()
    system.start()
    server.start()
    # not in the log, which everyone who reaches the master can read
    print(f'[INFO] [{time.time():.6f}]: Open {url(address, server.port, token)}')
    life.end_requested.wait()
    runs.stop()
    hand.end()
    server.stop()
    return 0


if __name__ == '__main__':
    life.run(main)
