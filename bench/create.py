#!/usr/bin/env python3
"""Measure the base node of a Create on the emulated robot: latency, CPU time, end pose of the exercise. See README.md.

Each exercise has its own roscore and robot. Latency and CPU time share a roscore and a robot. All processes are cleaned
up, even after Ctrl-C.
"""
import argparse
import math
import multiprocessing
import os
import random
import signal
import subprocess
import time

import bench
import figures
import processes
from probe import Probe, wait

ROBOTS = 'create', 'create2'
BASE = 'roslaunch rbx1_bringup fake_turtlebot_create.launch'
FILTER = 'roslaunch rbx1_bringup odom_ekf.launch'
BY_TIME = 'rosrun rbx1_nav timed_out_and_back.py'
COMBINED = 'rosrun rbx1_nav odom_out_and_back.py _odom_frame:=odom_combined'
COMMANDS = "rostopic pub -r 50 /cmd_vel geometry_msgs/Twist '[0.1, 0, 0]' '[0, 0, 0.2]'"
REST = 5        # s that the robot is stationary at first, so that the gyro offset can be determined
CPU_TIME = 20   # s of each measurement of CPU time
LIMIT = 120     # s of wall time for an exercise


def start_robot(session, robot_type, surface, seed, *others):
    """Start the robot, the base node and the other commands, and wait until the robot can be driven."""
    session.environment['PYTHONUNBUFFERED'] = '1'   # each line reaches the log as soon as it is printed
    session.start(f'{BASE} robot_type:={robot_type} surface:={surface} seed:={seed} port:={session.folder}/port')
    log = session.started[-1][2]
    for command in others:
        session.start(command)

    def ready():
        with open(log, errors='replace') as file:
            return 'in safe mode' in file.read()
    session.wait(ready, 'the robot to be in safe mode')
    time.sleep(REST)


def exercise(robot_type, surface, seed, driver, *others):
    """(m, degrees) between the robot's first and last pose, from ground truth."""
    with bench.Session() as session:
        start_robot(session, robot_type, surface, seed, *others)
        probe = Probe(session.changes, '/cmd_vel', '/ground_truth')
        session.wait(lambda: probe.ask('arrived', 1), '/ground_truth')
        try:
            status = session.start(driver).wait(LIMIT)
        except subprocess.TimeoutExpired:
            status = f'none after {LIMIT} s'
        if status or not probe.ask('settled', bench.SETTLE):
            raise bench.Failure(f'the exercise failed, exit status: {status}\n{session.output()}')
        row, _ = figures.run_figures(*probe.ask('record'), [], 0, None)
    return row['distance_m'], row['angle_deg']


def cpu(pids):
    """CPU time of the processes and their children for the next CPU_TIME seconds, in % of a core."""
    samples = [processes.sample(pids)]
    time.sleep(CPU_TIME)
    samples.append(processes.sample(pids))
    return 100 * figures.usage(samples, -math.inf, math.inf)


def line_delays(environment, count):
    """The delays (s) from `count` commands at random phases to their last byte at the robot; runs in a new process."""
    # Ctrl-C in the terminal reaches this process too, but the parent decides when to stop it
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    signal.signal(signal.SIGTERM, signal.SIG_DFL)
    os.environ.update(environment)
    import rospy
    from geometry_msgs.msg import Twist
    from std_msgs.msg import String
    rospy.init_node('bench_line', anonymous=True, disable_rostime=True, disable_rosout=True, disable_signals=True)
    texts, published = [], []
    rospy.Subscriber('/line', String, lambda message: texts.append(message.data), tcp_nodelay=True)
    publisher = rospy.Publisher('/cmd_vel', Twist, queue_size=1, tcp_nodelay=True)
    if not wait(lambda: texts and publisher.get_num_connections(), bench.START):
        raise bench.Failure('timed out waiting for /line')
    for index in range(count):
        time.sleep(random.uniform(0.05, 0.15))
        message = Twist()
        message.linear.x = 0.0 if index % 2 else 0.1
        published.append((time.time(), message.linear.x))   # /line uses ROS time, which equals this time
        publisher.publish(message)
    time.sleep(0.5)
    return figures.shown_after(published, figures.line_speeds(texts))


def measure_node(robot_type, seed, count):
    """Yield (what, text) for the node's CPU time, and for its latency with `count` commands."""
    with bench.Session() as session:
        start_robot(session, robot_type, 'ideal', seed)
        pids = [session.node_process('/turtlebot_node')]
        probe = Probe(session.changes, '/cmd_vel', '/odom')
        session.wait(lambda: probe.ask('arrived', 1), '/odom')
        yield 'CPU at rest', f'{cpu(pids):.2f} % of a core'
        commands = session.start(COMMANDS)
        time.sleep(REST)
        yield 'CPU, commands at 50 Hz', f'{cpu(pids):.2f} % of a core'
        processes.stop(commands)
        with multiprocessing.get_context('fork').Pool(1) as pool:
            delays = pool.apply(line_delays, (session.changes, count))
    shown = [delay for delay in delays if delay is not None]
    if not shown:
        raise bench.Failure('no command was shown on /line')
    numbers = ', '.join(f'{key} {1e3 * value:.2f}' for key, value in figures.spread(shown).items())
    yield 'command to line', f'{numbers} ms; {len(shown)} of {count} shown'


def measure(args):
    """Measure what the command line requests: yield (robot_type, what, text) for each."""
    for robot_type in ROBOTS if args.commands else ():
        for what, text in measure_node(robot_type, args.seed, args.commands):
            yield robot_type, what, text
    for what, surface, *commands in (('timed, ideal', 'ideal', BY_TIME),
                                     ('combined, carpet', 'low_ply_carpet', COMBINED, FILTER)):
        for robot_type in ROBOTS:
            for seed in range(args.seed, args.seed + args.runs):
                distance, angle = exercise(robot_type, surface, seed, *commands)
                yield robot_type, f'{what}, seed {seed}', f'{1e3 * distance:.1f} mm, {angle:.2f} degrees'


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument('--commands', type=int, default=300, metavar='N',
                        help='commands for the latency (default 300; 0: neither latency nor CPU time)')
    parser.add_argument('--runs', type=int, default=3, help='runs of each exercise and robot (default 3)')
    parser.add_argument('--seed', type=int, default=1, help='seed of the first run (default 1)')
    args = parser.parse_args()
    print(f'{"load":>5}  {"robot":8} {"figure":26} measured', flush=True)
    load = os.getloadavg()[0]
    with bench.cleaned_up():
        for robot_type, what, text in measure(args):
            print(f'{load:5.2f}  {robot_type:8} {what:26} {text}', flush=True)
            load = os.getloadavg()[0]


if __name__ == '__main__':
    main()
