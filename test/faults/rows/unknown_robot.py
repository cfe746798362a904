"""A base node is connected to a robot of unknown type and baud rate, and may be killed during its search."""
import itertools
import os
import signal
import time

import rospy
import support
from driven import STOP
from emulated import EmulatedRobot
from rbx1_nav.extras.create.protocol import command

FAULT = ('a base node with each robot_type is connected to each kind of robot at each baud rate; half of the nodes '
         'are killed by SIGKILL during the search')
PROMISE = ('the robot receives only start commands and queries until it is identified: it does not move, and none of '
           'its programs starts')
FULL, SHORT = 36, 6
ROOT = ALONE = False

PAIRS = list(itertools.product(('create', 'create2'), ('auto', 'create', 'create2'), (57600, 115200, 19200)))
SEARCH = 3.0        # s in which a robot of another type would be driven, were it driven at all
SEARCH_COMMANDS = {command('start'), command('sensors', 3), command('sensors', 43), command('sensors', 8),
                   command('pause_resume_stream', 0)}


def meet(case, robot, robot_type, kill_after):
    """One fault. kill_after: s after which the node is killed, or None."""
    node = support.Process('rosrun', 'rbx1_nav', 'turtlebot_node.py', f'_port:={robot.link}',
                           f'_robot_type:={robot_type}')
    case.addCleanup(node.kill)
    support.wait_for(robot.received, f'the search: {node.output}')
    end = time.monotonic() + (SEARCH if kill_after is None else kill_after)
    while time.monotonic() < end and 'Connected to a' not in node.output:
        time.sleep(0.005)
    if kill_after is not None:
        os.kill(support.pid_of('/turtlebot_node'), signal.SIGKILL)
        node.wait()
        time.sleep(0.5)     # for the guardian
    matches = robot_type in ('auto', robot.model.name)
    if kill_after is None:
        assert ('Connected to a' in node.output) == matches, node.output
        node.signal(signal.SIGINT)
        assert node.wait() == 0, node.output
    received = [data for _, data in robot.received()]
    known = received.index(STOP) if matches and STOP in received else len(received)
    assert set(received[:known]) <= SEARCH_COMMANDS, received[:known]
    speeds = {(odom.twist.twist.linear.x, odom.twist.twist.angular.z) for odom in list(robot.truth.messages)}
    assert speeds == {(0.0, 0.0)}, speeds


def run(row):
    """See FAULT."""
    row.roscore()
    support.init_node('faults')
    pairs = row.random.sample(PAIRS, len(PAIRS))
    for index in range(row.times):
        kind, robot_type, baud = pairs[index % len(pairs)]
        kill_after = row.random.uniform(0.0, 0.5) if index % 2 else None
        with row.case('robot_type %s, a %s at %d baud%s' % (
                robot_type, kind, baud, '' if kill_after is None else ', SIGKILL after %.3f s' % kill_after)) as case:
            meet(case, EmulatedRobot(case, kind, baud=baud), robot_type, kill_after)
        if rospy.has_param('/turtlebot_node'):
            rospy.delete_param('/turtlebot_node')
