#!/usr/bin/env python3
"""Record runs of timed_out_and_back.py with a live filter, and replay them to the filter and to robot_pose_ekf's
arithmetic. See README.md.

Each run has its own roscore on a free port of the loopback interface. All processes are cleaned up, even after Ctrl-C.
"""
import argparse
import math
import os
import subprocess
import sys
import tempfile
import time
from typing import NamedTuple

import numpy

import bench
from figures import deviation
from floors import consistency
import processes
from probe import Probe
from replay import gyro, odometry, replay, run_port
import simulated
from rbx1_nav.base.messages import yaw_of
from rbx1_nav.base.units import SECOND
from rbx1_nav.filter.priors import priors

SURFACE = 'low_ply_carpet'
BASE = f'roslaunch rbx1_bringup fake_turtlebot.launch surface:={SURFACE}'
FILTER = 'roslaunch rbx1_bringup odom_ekf.launch'
DRIVER = 'rosrun rbx1_nav timed_out_and_back.py'
RESET = 'rosservice call /arbotix/reset'
RECORDER = 'rosbag record --tcpnodelay'
TOPICS = '/odom', '/imu/data', '/odom_combined', '/ground_truth', '/rosout'
NODE = '/robot_pose_ekf'
REPORTS = 'has timed out', 'has recovered', '; rejected'    # log lines about dropouts and rejected messages
REST = 2        # s of simulated time before and after the exercise, and of wall time after it
STOP = 60       # s of wall time for the recorder to write the rest of its bag
LIMIT = 180     # s of wall time for the exercise
EARLY = 30      # estimates from which the start of the live filter is determined
STILL = 1e-3    # m and rad: odometry has moved if it differs by more than this from a pose at rest
COLUMNS = (('lines', 1, 0), ('diff mm', 1e3, 4), ('diff deg', 1, 5), ('end mm', 1e3, 2), ('end deg', 1, 3),
           ('port mm', 1e3, 2), ('port deg', 1, 3), ('NEES', 1, 2))  # title, factor, decimals


class Record(NamedTuple):
    """The contents of a bag, each list in stamp order (ns). A pose is (x, y, yaw) in m and rad."""
    odom: list      # these two: see replay.py
    imu: list
    truth: dict     # {stamp: pose}
    combined: list  # (stamp, pose, variance of the yaw) of each published estimate
    lines: list     # log lines of the filter


def subscribers(session, topic):
    """The names of the nodes that subscribe to a topic."""
    state = session.call(session.changes['ROS_MASTER_URI'], 'getSystemState') or ([], [])
    return dict(state[1]).get(topic, [])


def run(session, command):
    """Run a shell command to its end. Raises Failure."""
    try:
        subprocess.run(command, shell=True, env=session.environment, check=True, timeout=LIMIT,
                       stdout=subprocess.DEVNULL)
    except subprocess.SubprocessError as error:
        raise bench.Failure(error)


def record(path, seed, args):
    """Record one run to a bag. Raises Failure."""
    with bench.Session() as session:
        session.start(f'{BASE} seed:={seed} real_time_factor:={args.factor:g}')
        session.wait(lambda: session.node_uri('/arbotix'), 'the base')
        recorder = session.start(f'{RECORDER} -O {path} {" ".join(TOPICS)}')
        session.wait(lambda: all(any(name.startswith('/record') for name in subscribers(session, topic))
                                 for topic in TOPICS), 'the recorder')
        run(session, RESET)
        session.start(FILTER)
        probe = Probe(session.changes, '/cmd_vel', '/odom_ekf')
        session.wait(lambda: NODE in subscribers(session, '/imu/data'), 'the filter')
        session.wait(lambda: probe.ask('arrived'), '/odom_ekf')
        time.sleep(1)       # a registered node may not be connected yet

        loops = [subprocess.Popen([sys.executable, '-c', 'while True: pass']) for _ in range(args.load)]
        time.sleep(REST / args.factor)
        run(session, DRIVER)
        time.sleep(REST)
        for loop in loops:
            loop.kill()
        for process, command, _ in session.started:
            if process.poll() is not None:
                raise bench.Failure(f'"{command}" exited during the run')
        processes.stop(recorder, STOP)
        end = time.monotonic() + STOP
        while not os.path.exists(path):     # `rosbag` may exit before its recording process
            if time.monotonic() > end:
                raise bench.Failure(f'the recorder did not write {path} within {STOP} s')
            time.sleep(0.05)


def read(path):
    """The Record of a bag."""
    import rosbag
    found = {topic: [] for topic in TOPICS}
    with rosbag.Bag(path) as bag:
        for topic, message, _ in bag.read_messages(TOPICS):
            found[topic].append(message)

    def poses(topic):
        for message in found[topic]:
            pose = message.pose.pose
            yield message.header.stamp.to_nsec(), (pose.position.x, pose.position.y, yaw_of(pose.orientation))
    return Record(odometry(found['/odom']), gyro(found['/imu/data']), dict(poses('/ground_truth')),
                  [(*each, message.pose.covariance[35])
                   for each, message in zip(poses('/odom_combined'), found['/odom_combined'])],
                  [log.msg for log in found['/rosout'] if log.name == NODE])


def find_start(recording, prior):
    """The stamp of the first odometry that the live filter received.

    What the filter learns in the first rest, and so its first estimates, depends on it.
    """
    published = recording.combined[:EARLY]
    first, last = published[0][0], published[-1][0]
    starts = [odom.stamp for odom, _ in recording.odom if first - SECOND < odom.stamp <= first]

    def deviation(start):
        estimates = replay(recording, prior, start, last)
        return sum(abs(estimates[stamp].pose.yaw - pose[2]) + abs(estimates[stamp].covariance[2][2] - variance)
                   if stamp in estimates else math.inf for stamp, pose, variance in published)
    return min(starts, key=deviation)


def exercise(recording):
    """The stamps from REST before the first motion to REST after the last one."""
    poses = numpy.array([odom.pose for odom, _ in recording.odom])
    moved = [abs(poses - rest).max(axis=1) > STILL for rest in (poses[0], poses[-1])]
    stamps = [odom.stamp for (odom, _), *moves in zip(recording.odom, *moved) if all(moves)]
    return stamps[0] - REST * SECOND, stamps[-1] + REST * SECOND


def difference(pose, other):
    """(m, degrees) between two poses."""
    metres, angle = deviation(pose, other)
    return metres, math.degrees(angle)


def evaluate(recording, prior):
    """The figures of a run, in the order of COLUMNS."""
    begin, end = exercise(recording)
    # the live filter, and a filter that receives what was recorded, from the start of the live one on
    live = replay(recording, prior, find_start(recording, prior), end)
    stamp, pose, _ = max(each for each in recording.combined if each[0] in live)
    # the errors: from one standstill to the other, so they do not depend on how long the driver took to start
    estimates = replay(recording, prior, begin, end)
    last = max(stamp for stamp in estimates if stamp in recording.truth)
    truth, estimate = recording.truth[last], estimates[last]
    return (sum(any(text in line for text in REPORTS) for line in recording.lines),
            *difference(pose, live[stamp].pose), *difference(estimate.pose, truth),
            *difference(run_port(recording, min(estimates), last)[-1], truth),
            consistency(estimate.pose, truth, estimate.covariance))


def line(name, values):
    """One line of the table."""
    return ' '.join([f'{name:>6}', *(f'{factor * value:8.{places}f}' for (_, factor, places), value in zip(
        COLUMNS, values))])


def measure(args, folder):
    """Record, evaluate and print all runs."""
    prior = priors(simulated.floor(SURFACE))
    print(' '.join(['  seed', *(f'{title:>8}' for title, *_ in COLUMNS)]), flush=True)
    rows = []
    for seed in range(args.runs):
        path = os.path.join(folder, f'seed_{seed}.bag')
        record(path, seed, args)
        rows.append(evaluate(read(path), prior))
        print(line(seed, rows[-1]), flush=True)
        os.remove(path)
    print(line('mean', numpy.mean(rows, axis=0)))
    print(line('max', numpy.max(rows, axis=0)))


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument('--runs', type=int, default=10, help='number of runs, with the seeds from 0 (default 10)')
    parser.add_argument('--factor', type=float, default=20, help='real_time_factor of the base (default 20)')
    parser.add_argument('--load', type=int, default=0, metavar='N', help='busy loops during each run (default 0)')
    args = parser.parse_args()
    with bench.cleaned_up(), tempfile.TemporaryDirectory(prefix='bench_bags_') as folder:
        measure(args, folder)


if __name__ == '__main__':
    main()
