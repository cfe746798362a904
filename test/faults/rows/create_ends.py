"""The base node of an emulated Create ends in motion, while its driver goes on."""
import contextlib
import signal
import subprocess
import time

import rospy

import support
from driven import STOP, faults_of_both
from rbx1_nav.extras.create.protocol import command

FAULT = ("Ctrl-C, SIGTERM or `rosnode kill` to a Create's base node, or Ctrl-C to its roslaunch, at a random moment of "
         'a motion; its driver goes on at 10, 20 or 50 Hz, is `timed_out_and_back.py`, or is silent')
PROMISE = ('the robot confirms that it has stopped, and the node exits with status 0; the robot stands within 0.3 s; '
           'after the first stop, no command moves it')
FULL, SHORT = 40, 5
ROOT = False
ALONE = True    # it measures a duration

LIMIT = 0.3     # s
WAIT = 3        # s
DRIVE = command('drive_direct')[0]
ENDS = ('SIGINT', 'SIGTERM', 'rosnode kill', 'roslaunch')
SENDERS = (10, 20, 50, 'script', 0)


def end(robot, how):
    """End the node."""
    if how == 'rosnode kill':
        subprocess.run(['rosnode', 'kill', '/turtlebot_node'], check=True, stdout=subprocess.DEVNULL)
    else:
        robot.node.signal(getattr(signal, how, signal.SIGINT))


@contextlib.contextmanager
def driver(robot, sender):
    """A context in which the robot moves. It returns an Event that ends the commands of a driver that is no script."""
    if sender != 'script':
        with robot.driving(0.2, 0.3, sender or 50) as left:
            yield left
        return
    script = support.out_and_back()
    try:
        support.wait_for(lambda: robot.moving, 'the robot to move')
        yield None
    finally:
        script.kill()


def check(row, robot, seconds, how, sender):
    """End the node `seconds` after the robot has begun to move."""
    with driver(robot, sender) as left:
        time.sleep(seconds)
        if sender == 0:
            left.set()
        count, asked = len(robot.received()), rospy.get_time()
        end(robot, how)
        status = robot.node.wait()
        support.wait_for(lambda: not robot.moving, 'a stop', WAIT)
        since = robot.received()[count:]
        first = next(index for index, (_, data) in enumerate(since) if data == STOP)
        if how != 'rosnode kill':       # rosnode needs a second to start
            row.figure('first stop after (s)', since[first][0] - asked)
        moved = [data for _, data in since[first:] if data[0] == DRIVE and data != STOP]
        assert not moved, f'commands after the stop: {moved}'
        assert status == 0 and 'has not confirmed' not in robot.node.output, (status, robot.node.output)
        standing = next(each.header.stamp.to_sec() for each in robot.truth.messages
                        if each.header.stamp.to_sec() > since[first][0] and not each.twist.twist.linear.x)
        assert standing - since[first][0] < LIMIT, f'{standing - since[first][0]:.3f} s'


def run(row):
    """See FAULT."""
    for robot_type, robot, index in faults_of_both(row):
        how, sender = ENDS[index % len(ENDS)], SENDERS[index // len(ENDS) % len(SENDERS)]
        seconds = row.random.uniform(0.2, 1.5)
        if how == 'roslaunch':
            robot.end_node(robot.node)
            robot.node = support.Process('roslaunch', '--wait', 'rbx1_bringup', 'turtlebot_minimal_create.launch',
                                         f'port:={robot.link}')
            robot.node.wait_for_line('in safe mode')
        with row.fault(f'{robot_type}: {how}, its driver: {sender}, after {seconds:.3f} s'):
            check(row, robot, seconds, how, sender)
        robot.node.kill()
        robot.node = robot.start_node()
        robot.node.wait_for_line('in safe mode')
