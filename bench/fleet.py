#!/usr/bin/env python3
"""Drive many simulated robots at once in real time, and record all of them with rosbag. See README.md."""
import argparse
from collections import Counter, defaultdict
import math
import os
import subprocess
import time

import bench
import figures
import processes

PARAMETERS = '$(rospack find rbx1_nav)/config/turtlebot.yaml'
SCRIPT = 'exec rosrun rbx1_nav timed_out_and_back.py'
LIMIT = 120             # s of wall time for all scripts
PERIOD = 0.5            # s between two samples of the CPU time


def robot(index):
    """Return the name of a robot."""
    return f'robot{index + 1}'


def start_bases(session, count, together):
    """Start the bases, in one process if `together`; return their processes."""
    loading = ' && '.join(f'rosparam load {PARAMETERS} /{robot(index)}/arbotix' for index in range(count))
    subprocess.run(loading, shell=True, env=session.environment, check=True)
    if together:
        bases = [session.start(f'exec rosrun rbx1_nav fleet.py _robots:={count}')]
    else:
        bases = [session.start(f'ROS_NAMESPACE={robot(index)} exec rosrun rbx1_nav fake_base.py __name:=arbotix')
                 for index in range(count)]
    for index in range(count):
        session.wait(lambda: session.call(session.changes['ROS_MASTER_URI'], 'lookupService',
                                          f'/{robot(index)}/arbotix/reset'), robot(index))
    return bases


def read(path):
    """Return (forward, turning) commands by robot, and the stamps of its odometry from its first to its last motion."""
    import rosbag
    commands, odometry = defaultdict(lambda: [0, 0]), defaultdict(list)
    with rosbag.Bag(path) as bag:
        for topic, message, time_ in bag.read_messages():
            name, kind = topic.split('/')[1:]
            twist = message if kind == 'cmd_vel' else message.twist.twist
            motion = bool(twist.linear.x), bool(twist.angular.z)
            if kind == 'odom':
                odometry[name].append((time_.to_sec(), any(motion)))
            else:
                commands[name] = [count + moves for count, moves in zip(commands[name], motion)]
    driven = {}
    for name, stamps in odometry.items():
        moving = [index for index, (_, moves) in enumerate(stamps) if moves] or [0]
        driven[name] = [stamp for stamp, _ in stamps[moving[0]:moving[-1] + 1]]
    return {name: tuple(counts) for name, counts in commands.items()}, driven


def measure(count, together):
    """Print the figures of one run of `count` robots."""
    with bench.Session() as session:
        bases = start_bases(session, count, together)
        path = os.path.join(session.folder, 'fleet.bag')
        topics = ' '.join(f'/{robot(index)}/{kind}' for index in range(count) for kind in ('odom', 'cmd_vel'))
        recorder = session.start(f'exec rosbag record --tcpnodelay -b 0 -O {path} {topics}')
        session.wait(lambda: os.path.exists(path + '.active'), 'rosbag')
        scripts = [session.start(f'ROS_NAMESPACE={robot(index)} {SCRIPT}') for index in range(count)]
        pids = [[process.pid for process in group] for group in (bases, scripts)]
        samples = []        # (time, sample of the bases, sample of the scripts)
        limit = time.monotonic() + LIMIT
        while any(script.poll() is None for script in scripts):
            if time.monotonic() > limit:
                raise bench.Failure(f'a script runs longer than {LIMIT} s')
            samples.append((time.time(), *map(processes.sample, pids)))
            time.sleep(PERIOD)
        failed = sum(script.returncode != 0 for script in scripts)
        if not processes.stop(recorder, timeout=LIMIT):
            raise bench.Failure(f'rosbag has not exited after {LIMIT} s')
        commands, driven = read(path)
    begin, end = max(stamps[0] for stamps in driven.values()), min(stamps[-1] for stamps in driven.values())
    used = [figures.usage([sample[group] for sample in samples if begin < sample[0] < end], 0, math.inf)
            for group in (1, 2)]
    intervals = [after - before for stamps in driven.values() for before, after in zip(stamps, stamps[1:])]
    print(f"{count} robots, {'one process' if together else 'a process each'}: {failed} scripts failed")
    for (forward, turning), robots in Counter(commands.values()).most_common():
        print(f'  {robots} robots received {forward} forward commands and {turning} turn commands')
    print(f'  intervals of /odom: median {1000 * figures.percentile(intervals, 50):.1f} ms, 99 % '
          f'{1000 * figures.percentile(intervals, 99):.1f} ms, maximum {1000 * max(intervals):.0f} ms')
    if None in used:
        raise bench.Failure('the robots never drove all at the same time: expected a faster machine')
    print(f'  CPU time: bases {100 * used[0]:.0f} %, scripts {100 * used[1]:.0f} % of a core', flush=True)


def main():
    """Run the benchmark."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument('count', type=int, nargs='+', help='number of robots, one or several numbers')
    parser.add_argument('--together', action='store_true', help='all bases in one process; default: a process each')
    arguments = parser.parse_args()
    with bench.cleaned_up():
        for count in arguments.count:
            measure(count, arguments.together)


if __name__ == '__main__':
    main()
