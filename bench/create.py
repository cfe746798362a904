#!/usr/bin/env python3
"""Measure the latency and the CPU time of the base node of a Create on the emulated robot. See README.md.

All processes are cleaned up, even after Ctrl-C.
"""
import argparse
import math
import os
import time

import bench
import figures
import processes
from probe import Probe

ROBOTS = 'create', 'create2'
BASE = 'roslaunch rbx1_bringup fake_turtlebot_create.launch'
COMMANDS = "rostopic pub -r 50 /cmd_vel geometry_msgs/Twist '[0.1, 0, 0]' '[0, 0, 0.2]'"
REST = 5        # s that the robot is stationary at first, so that the gyro offset can be determined
CPU_TIME = 20   # s of each measurement of CPU time


def cpu(pids):
    """CPU time of the processes and their children for the next CPU_TIME seconds, in % of a core."""
    samples = [processes.sample(pids)]
    time.sleep(CPU_TIME)
    samples.append(processes.sample(pids))
    return 100 * figures.usage(samples, -math.inf, math.inf)


def measure(robot_type, count):
    """Yield (what, text) for the node's CPU time, and for its latency with `count` commands."""
    with bench.Session() as session:
        session.environment['PYTHONUNBUFFERED'] = '1'   # each line reaches the log as soon as it is printed
        session.start(f'{BASE} robot_type:={robot_type} port:={session.folder}/port')
        session.wait(lambda: 'in safe mode' in session.output(), 'the robot to be in safe mode')
        time.sleep(REST)
        pids = [session.node_process('/turtlebot_node')]
        probe = Probe(session.changes, '/cmd_vel', '/odom')
        session.wait(lambda: probe.ask('arrived'), '/odom')
        yield 'CPU at rest', f'{cpu(pids):.2f} % of a core'
        commands = session.start(COMMANDS)
        time.sleep(REST)
        yield 'CPU, commands at 50 Hz', f'{cpu(pids):.2f} % of a core'
        processes.stop(commands)
        session.started.pop()   # or wait() would report that it has exited
        line = Probe(session.changes, '/cmd_vel', '/line', publish=True)
        session.wait(lambda: line.ask('arrived'), '/line')
        delays = line.ask('latency', count)
    shown = [delay for delay in delays if delay is not None]
    if not shown:
        raise bench.Failure('no command was shown on /line')
    numbers = ', '.join(f'{key} {1e3 * value:.2f}' for key, value in figures.spread(shown).items())
    yield 'command to line', f'{numbers} ms; {len(shown)} of {count} shown'


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument('--commands', type=int, default=300, metavar='N', help='commands for the latency (default 300)')
    args = parser.parse_args()
    print(f'{"load":>5}  {"robot":8} {"figure":26} measured', flush=True)
    load = os.getloadavg()[0]
    with bench.cleaned_up():
        for robot_type in ROBOTS:
            for what, text in measure(robot_type, args.commands):
                print(f'{load:5.2f}  {robot_type:8} {what:26} {text}', flush=True)
                load = os.getloadavg()[0]


if __name__ == '__main__':
    main()
