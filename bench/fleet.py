#!/usr/bin/env python3
"""Drive many simulated robots at once in real time, and record all of them with rosbag. See README.md."""
import argparse
from collections import Counter, defaultdict
import os
import subprocess
import sys
import time

import bench
import figures
import processes

PARAMETERS = '$(rospack find rbx1_nav)/config/turtlebot.yaml'
SCRIPT = 'exec rosrun rbx1_nav timed_out_and_back.py'
LIMIT = 120             # s of wall time for all scripts
BEGIN, EACH = 2.0, 0.25     # s after the start of the scripts, and for each of them, until all of them drive
PERIOD = 8              # s of the measurement of CPU time


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
        time.sleep(BEGIN + EACH * count)
        begin = time.time()
        both = [[process.pid for process in group] for group in (bases, scripts)]
        before = [processes.sample(pids) for pids in both]
        time.sleep(PERIOD)
        after = [processes.sample(pids) for pids in both]
        end = time.time()
        used = [100 * figures.usage(pair, 0, after[-1][0]) for pair in zip(before, after)]
        try:
            failed = sum(script.wait(LIMIT) != 0 for script in scripts)
        except subprocess.TimeoutExpired:
            raise bench.Failure(f'a script runs longer than {LIMIT} s') from None
        if not processes.stop(recorder, timeout=LIMIT):
            raise bench.Failure(f'rosbag has not exited after {LIMIT} s')
        commands, driven = read(path)
    if any(begin < stamps[0] or stamps[-1] < end for stamps in driven.values()):
        raise bench.Failure('not all robots drove while the CPU time was measured: expected a faster machine')
    intervals = [after - before for stamps in driven.values() for before, after in zip(stamps, stamps[1:])]
    print(f"{count} robots, {'one process' if together else 'a process each'}: {failed} scripts failed")
    for (forward, turning), robots in Counter(commands.values()).most_common():
        print(f'  {robots} robots received {forward} forward commands and {turning} turn commands')
    print(f'  intervals of /odom: median {1000 * figures.percentile(intervals, 50):.1f} ms, 99 % '
          f'{1000 * figures.percentile(intervals, 99):.1f} ms, maximum {1000 * max(intervals):.0f} ms')
    print(f'  CPU time: bases {used[0]:.0f} %, scripts {used[1]:.0f} % of a core', flush=True)


def main():
    """Run the benchmark; returns the exit status."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument('count', type=int, nargs='+', help='number of robots, one or several numbers')
    parser.add_argument('--together', action='store_true', help='all bases in one process; default: a process each')
    arguments = parser.parse_args()
    bench.prepare()
    try:
        for count in arguments.count:
            measure(count, arguments.together)
    except (bench.Failure, bench.Interrupted) as error:
        print(f'bench: {error}', file=sys.stderr)
        return 1
    return 0


if __name__ == '__main__':
    sys.exit(main())
