#!/usr/bin/env python3
"""Record runs of timed_out_and_back.py with a live filter, and replay them to the filter and to robot_pose_ekf's
arithmetic. See README.md.

Each run has its own roscore on a free port of the loopback interface. All processes are cleaned up, even after Ctrl-C.
"""
import argparse
import json
import math
import os
import shutil
import subprocess
import sys
import tempfile
import time

import bench
import processes
import replay
from probe import Probe

BASE = 'roslaunch rbx1_bringup fake_turtlebot.launch'
FILTER = 'roslaunch rbx1_bringup odom_ekf.launch'
DRIVER = 'rosrun rbx1_nav timed_out_and_back.py'
RESET = 'rosservice call /arbotix/reset'
RECORDER = 'rosbag record --tcpnodelay'
TOPICS = '/odom', '/imu/data', '/odom_combined', '/ground_truth', '/rosout', '/statistics'
NODE = '/robot_pose_ekf'
FREQ = 10       # Hz, of odom_combined, as in odom_ekf.launch
REST = 2        # s of simulated time before and after the exercise, and of wall time after it
STOP = 60       # s of wall time for the recorder to write the rest of its bag
RUNS = '%4s %6s %6s %5s %5s %5s %4s %8s %8s %7s %7s %7s %7s %6s  %s'
TITLES = ('seed', 'x real', 'sim s', 'lines', 'rec.', 'filt.', 'same', 'diff mm', 'diff deg', 'end mm', 'end deg',
          'port mm', 'deg', 'NEES', 'remarks')


def subscribers(session, topic):
    """The names of the nodes that subscribe to a topic."""
    state = session.call(session.changes['ROS_MASTER_URI'], 'getSystemState') or ([], [])
    return dict(state[1]).get(topic, [])


def finish(session, process, limit):
    """Wait until a command exits on its own. Raises Failure."""
    try:
        status = process.wait(limit)
    except subprocess.TimeoutExpired:
        status = f'none after {limit:g} s'
    if status:
        command = next(command for started, command, _ in session.started if started is process)
        raise bench.Failure(f'"{command}": exit status {status}\n{session.output()}')
    session.started = [each for each in session.started if each[0] is not process]     # the others must keep running


def record(path, seed, args):
    """Record one run to a bag; returns the real-time factor that it reached. Raises Failure."""
    with bench.Session() as session:
        session.start(f'{BASE} surface:={args.surface} seed:={seed} real_time_factor:={args.factor:g}')
        session.wait(lambda: session.node_uri('/arbotix'), 'the base')
        recorder = session.start(f'{RECORDER} -O {path} {" ".join(TOPICS)}')
        session.wait(lambda: all(any(name.startswith('/record') for name in subscribers(session, topic))
                                 for topic in TOPICS), 'the recorder')
        finish(session, session.start(RESET), bench.START)
        # the filter counts its lost messages; only on its own subscriptions, so that nothing else is slowed down
        master = session.changes['ROS_MASTER_URI']
        session.call(master, 'setParam', '/enable_statistics', True)
        session.start(FILTER)
        probe = Probe(session.changes, '/cmd_vel', '/odom_ekf')
        session.wait(lambda: NODE in subscribers(session, '/imu/data'), 'the filter')
        session.call(master, 'setParam', '/enable_statistics', False)
        session.wait(lambda: probe.ask('arrived', 1), '/odom_ekf')
        time.sleep(1)       # a registered node may not be connected yet

        loops = [subprocess.Popen([sys.executable, '-c', 'while True: pass']) for _ in range(args.load)]
        began = time.monotonic()
        time.sleep(REST / args.factor)
        finish(session, session.start(DRIVER), args.limit)
        time.sleep(REST)
        for loop in loops:
            loop.kill()
        for process, command, _ in session.started:
            if process.poll() is not None:
                raise bench.Failure(f'"{command}" exited during the run')
        received = [row[:2] for row in probe.ask('record')[1] if row[0] > began]
        processes.stop(recorder, STOP)
        end = time.monotonic() + STOP
        while not os.path.exists(path):     # `rosbag` may exit before its recording process
            if time.monotonic() > end:
                raise bench.Failure(f'the recorder did not write {path} within {STOP} s')
            time.sleep(0.05)
    return (received[-1][1] - received[0][1]) / (received[-1][0] - received[0][0]) if len(received) > 1 else math.nan


def read(path):
    """The Recording in a bag."""
    import rosbag
    from rbx1_nav.filter.gyro_input import GyroInput
    from rbx1_nav.base import messages
    from rbx1_nav.filter import conversions
    gyro = GyroInput()
    found = replay.Recording([], [], {}, [], [], {}, [])
    headers = {topic: [] for topic in TOPICS[:4]}
    with rosbag.Bag(path) as bag:
        for topic, message, _ in bag.read_messages(TOPICS):
            if topic in headers:
                stamp = message.header.stamp.to_nsec()
                headers[topic].append((message.header.seq, stamp))
            if topic == '/odom':
                found.odom.append((conversions.from_odometry(message), replay.pose_variances(message)))
            elif topic == '/imu/data':
                data = conversions.from_imu(message)
                found.imu.append((gyro.read(data), (messages.yaw_of(message.orientation), data.yaw_variance)))
                gyro.accepted(data)
            elif topic in ('/odom_combined', '/ground_truth'):
                pose = message.pose.pose
                pose = pose.position.x, pose.position.y, messages.yaw_of(pose.orientation)
                if topic == '/ground_truth':
                    found.truth[stamp] = pose
                else:
                    found.combined.append(replay.Published(stamp, pose, message.pose.covariance[35]))
            elif topic == '/statistics':
                if message.node_sub == NODE and message.topic in TOPICS[:2]:
                    found.statistics.append((message.window_start.to_nsec(), message.window_stop.to_nsec(),
                                             message.dropped_msgs))
            elif message.name == NODE:
                found.lines.append(message.msg)
    found.missing.update((topic, replay.gaps(those)) for topic, those in headers.items())
    return found


def evaluate(path, surface):
    """The figures of a bag, and the log lines of the filter. Raises Failure."""
    import rosbag
    from rbx1_nav.filter.priors import priors
    from rbx1_nav.base.surfaces import load_surface
    from rbx1_nav.node import resources
    try:
        recording = read(path)
    except (OSError, rosbag.ROSBagException) as error:
        raise bench.Failure(f'{path}: expected a bag: {error}')
    prior = priors(load_surface(surface, resources.surfaces()))
    try:
        return {**replay.live_figures(recording, prior, round(1e9 / FREQ)), **replay.end_figures(recording, prior),
                'messages': {'odom': len(recording.odom), 'imu': len(recording.imu),
                             'combined': len(recording.combined)}, 'lines': recording.lines}
    except replay.Unusable as error:
        raise bench.Failure(f'{path}: {error}')


def line(row):
    """One line of the table."""
    count = row['timed_out'], row['recovered'], row['rejected']
    remarks = [f'{number} {name}' for name, number in zip(('timed out', 'recovered', 'rejected'), count) if number]
    remarks += [] if row['scheduled'] else ['other stamps']
    remarks += [] if row['differs_after_s'] is None else [f'differs after {row["differs_after_s"]:.2f} s']
    return RUNS % (row['seed'], f'{row["real_time_factor"]:.2f}', f'{row["replayed_s"]:.1f}', sum(count),
                   sum(row['missing'][topic] for topic in TOPICS[:3]), row['dropped'], 'yes' if row['same'] else 'no',
                   f'{1e3 * row["difference_m"]:.4f}', f'{row["difference_deg"]:.5f}', f'{1e3 * row["error_m"]:.2f}',
                   f'{row["error_deg"]:.3f}', f'{1e3 * row["port_m"]:.2f}', f'{row["port_deg"]:.3f}',
                   f'{row["nees"]:.2f}', ', '.join(remarks))


def report(rows):
    """Print the means and the figures beyond the limits; returns both."""
    mean, found = replay.means(rows), replay.misses(rows)
    print(f'mean of {len(rows)}: end {1e3 * mean["error_m"]:.2f} mm, {mean["error_deg"]:.3f} degrees; '
          f'the port {1e3 * mean["port_m"]:.2f} mm, {mean["port_deg"]:.3f} degrees; NEES {mean["nees"]:.2f}')
    same = [row for row in rows if row['same']]
    print(f'{sum(row["timed_out"] + row["recovered"] + row["rejected"] for row in rows)} lines about dropouts and '
          f'rejected messages; in {len(same)} runs the filter got the messages that were recorded'
          + (f': at most {1e3 * max(row["difference_m"] for row in same):.4f} mm and '
             f'{max(row["difference_deg"] for row in same):.5f} degrees from the replay' if same else ''))
    print('\n'.join(f'beyond the limits: {text}' for text in found) or 'within all limits')
    return mean, found


def arguments():
    """The command line."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument('--runs', type=int, default=10, help='number of runs, with the seeds from 0 (default 10)')
    parser.add_argument('--factor', type=float, default=20, help='real_time_factor of the base (default 20)')
    parser.add_argument('--load', type=int, default=0, metavar='N', help='busy loops during each run (default 0)')
    parser.add_argument('--surface', default='low_ply_carpet', help='the floor (default low_ply_carpet)')
    parser.add_argument('--limit', type=float, default=180, help='timeout of the driver, s of wall time (default 180)')
    parser.add_argument('--bags', metavar='DIR', help='keep the bags in this folder')
    parser.add_argument('--replay', action='store_true', help='record nothing, but evaluate the bags in that folder')
    parser.add_argument('--json', metavar='FILE', help='write all figures to this file')
    args = parser.parse_args()
    for name, good in (('runs', args.runs > 0), ('factor', args.factor > 0), ('limit', args.limit > 0)):
        if not good:
            parser.error(f'--{name}: {getattr(args, name):g}: expected a number above 0')
    if args.load < 0:
        parser.error(f'--load: {args.load}: expected at least 0')
    if args.replay and not args.bags:
        parser.error('--replay: expected --bags DIR as well')
    return args


def measure(args, folder, result):
    """Record and evaluate all runs; adds the figures to `result`."""
    print(RUNS % TITLES, flush=True)
    for seed in range(args.runs):
        path = os.path.join(folder, f'seed_{seed}.bag')
        factor = math.nan if args.replay else record(path, seed, args)
        row = dict(seed=seed, real_time_factor=factor, **evaluate(path, args.surface))
        result['runs'].append(row)
        print(line(row), flush=True)
        if not args.bags:
            os.remove(path)
    result['mean'], result['misses'] = report(result['runs'])


def main():
    args = arguments()
    bench.prepare()
    if args.bags:
        os.makedirs(args.bags, exist_ok=True)
    folder = os.path.abspath(args.bags) if args.bags else tempfile.mkdtemp(prefix='bench_bags_')
    result = {'arguments': vars(args), 'host': bench.host(), 'runs': []}
    try:
        measure(args, folder, result)
    except bench.Failure as failure:
        result['failure'] = str(failure)
        sys.exit(f'bench: {failure}')
    except bench.Interrupted as signalled:
        result['failure'] = str(signalled)
        print(f'bench: {signalled}', file=sys.stderr)
        sys.exit(130)
    finally:
        processes.kill_rest()
        if not args.bags:
            shutil.rmtree(folder, ignore_errors=True)
        if args.json:
            with open(args.json, 'w') as file:
                json.dump(result, file, indent=1)


if __name__ == '__main__':
    main()
