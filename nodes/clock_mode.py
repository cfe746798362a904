#!/usr/bin/env python3
"""Prints a value for /use_sim_time, or refuses it because a robot is running with the other value.

usage: clock_mode.py true|false NAME      used by launch files; NAME: the name of the base that the launch file starts

A node reads /use_sim_time only once, when it starts. Exits with 1 before anything is set if a live base other than NAME
uses the other value.
"""
from __future__ import annotations

import re
import socket
import sys
import xmlrpc.client

import rosgraph     # not rospy: a launch file waits for this program, and the import takes most of its time

TIMEOUT = 2.0       # s for the master or a base to answer


def bases_on_other_clock(simulated: bool, but: str) -> list[str]:
    """Return the names of live bases if they run in simulated time and `simulated` is false, or the other way round.

    A base publishes odometry and subscribes to cmd_vel. but: the name of a base that is not listed. Raises an
    exception if the master does not answer.
    """
    master = rosgraph.Master('clock_mode')
    if bool(master.hasParam('/use_sim_time') and master.getParam('/use_sim_time')) == simulated:
        return []
    publishers, subscribers, _ = master.getSystemState()
    odometry = {topic for topic, kind in master.getTopicTypes() if kind == 'nav_msgs/Odometry'}
    publishing = {name for topic, names in publishers if topic in odometry for name in names}
    commanded = {name for topic, names in subscribers if topic.endswith('/cmd_vel') for name in names}
    return sorted(name for name in publishing & commanded - {but} if is_alive(master, name))


def is_alive(master: rosgraph.Master, name: str) -> bool:
    """Return whether a registered node answers, or may be alive on a host that cannot be reached."""
    try:
        return bool(xmlrpc.client.ServerProxy(master.lookupNode(name)).getPid('/clock_mode'))
    except (socket.timeout, socket.gaierror):   # suspended; its host drops packets, or has no address here
        return True
    except Exception:       # nothing, or another program, listens at the port of a node that was killed
        return False


def main() -> int:
    """Print the value; return the exit status."""
    if len(sys.argv) < 3:
        print(__doc__.strip(), file=sys.stderr)
        return 2
    socket.setdefaulttimeout(TIMEOUT)
    value, name = sys.argv[1].lower(), ' '.join(sys.argv[2:])
    if value not in ('true', 'false'):
        print(f'simulated_time: {sys.argv[1]!r}: expected true or false', file=sys.stderr)
        return 2
    if not re.fullmatch(r'(/[A-Za-z]\w*){1,2}', name, re.ASCII):
        robot = name.rpartition('/')[0].lstrip('/')
        print(f'robot: {robot!r}: expected a name of letters, digits and underscores that begins with a letter',
              file=sys.stderr)
        return 2
    try:
        running = bases_on_other_clock(value == 'true', name)
    except Exception:       # no master yet: no base; or another server at its port, which roslaunch reports
        running = []
    if running:
        now = 'simulated' if value == 'false' else 'real'
        print(f"/use_sim_time: {value}: expected no robot in {now} time, but {', '.join(running)} runs: "
              f'stop it first, or start this robot in {now} time as well', file=sys.stderr)
        return 1
    print(value)
    return 0


if __name__ == '__main__':
    sys.exit(main())
