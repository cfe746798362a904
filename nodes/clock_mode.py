#!/usr/bin/env python3
"""Prints a value for /use_sim_time, or refuses it because a robot is running with the other value.

usage: clock_mode.py true|false NAME      used by launch files; NAME: the name of the base that the launch file starts

A node reads /use_sim_time only once, when it starts. Exits with 1 before anything is set if a live base other than NAME
uses the other value.
"""
import re
import sys

from rbx1_nav.ros.network import bases


def main() -> int:
    """Print the value; return the exit status."""
    if len(sys.argv) < 3 or sys.argv[1].lower() not in ('true', 'false'):
        print(__doc__.strip(), file=sys.stderr)
        return 2
    value, name = sys.argv[1].lower(), ' '.join(sys.argv[2:])
    if not re.fullmatch(r'(/[A-Za-z]\w*)+', name, re.ASCII):
        robot = name.rpartition('/')[0].lstrip('/')
        print(f'robot: {robot!r}: expected a name of letters, digits and underscores that begins with a letter',
              file=sys.stderr)
        return 2
    running = bases.on_other_clock(value == 'true', name)
    if running:
        now = 'simulated' if value == 'false' else 'real'
        print(f"/use_sim_time: {value}: expected no robot in {now} time, but {', '.join(running)} runs: "
              f'stop it first, or start this robot in {now} time as well', file=sys.stderr)
        return 1
    print(value)
    return 0


if __name__ == '__main__':
    sys.exit(main())
