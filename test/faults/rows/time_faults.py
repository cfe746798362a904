"""Clocks that jump: the system clock as a node sees it, and simulated time."""
import math
import time

import rospy
import yaml
from geometry_msgs.msg import PoseWithCovarianceStamped

import support
from sensors import Sensors
from unsteady_time import PACKAGE, Time

FAULT = ('the system clock of a script or of the filter steps by an hour; simulated time jumps forward or backward, or '
         'stops for 2 s')
PROMISE = 'finite values, no false success, and no hang'
FULL, SHORT = 21, 2
ROOT = ALONE = False

SPEED = 0.2     # m/s
NEAR = 0.03     # m and rad: an end that counts as exact in real time


def start_base(clock):
    """Start a base at the origin; returns its odometry."""
    with open(f'{PACKAGE}/config/turtlebot.yaml', encoding='utf-8') as file:
        rospy.set_param('/arbotix', yaml.safe_load(file))
    clock.row.start('rosrun', 'rbx1_nav', 'fake_base.py').wait_for_line('Ready: ')
    return support.OdomWatch()


def script_in_motion(row, clock, jump, script):
    """The clock of a script, or of all nodes, jumps while it drives."""
    odom = start_base(clock)
    driver = clock.start(script, '_goal_distance:=0.3', '_goal_angle:=3.14')
    odom.wait_for_twist(SPEED) if script.startswith('timed') else support.wait_for(
        lambda: odom.last.twist.twist.linear.x > 0.1, 'the start')
    time.sleep(row.random.uniform(0, 2))
    jump()
    status = driver.wait()
    x, y, heading = support.pose(odom.last)
    off = math.hypot(x - 0.3 * (1 + math.cos(3.14)), y - 0.3 * math.sin(3.14))
    assert 'Traceback' not in driver.output, driver.output[-1500:]
    velocity = odom.next().twist.twist
    assert (velocity.linear.x, velocity.angular.z) == (0, 0), 'the robot still moves after the script has exited'
    row.figure('exit status of the script', status)
    if status == 0:
        row.figure('distance from the exact end pose with status 0 (m)', off)
        turned = abs(support.wrapped(heading))
        assert off < NEAR and turned < NEAR, f'status 0, but {off:.3f} m and {turned:.3f} rad off'


def filter_in_use(row, clock, jump):
    """The clock of the filter jumps while the sensors' stamps go on."""
    clock.start('ekf.py', 'odom:=/odom_sent')
    poses = support.Watch('/robot_pose_ekf/odom_combined', PoseWithCovarianceStamped)
    if not row.sensors:
        row.sensors = Sensors('/odom_sent')
        row.sensors.start()
    poses.next()
    jump()
    time.sleep(1)
    clock.step(0)
    count = len(poses.messages)
    support.wait_for(lambda: len(poses.messages) > count + 3, 'a pose after the clock is right again')
    assert all(math.isfinite(n) for m in poses.messages for n in [*support.pose(m), *m.pose.covariance]), \
        'a value that is not finite'


def run(row):
    """See FAULT."""
    row.roscore()
    support.init_node('faults')
    row.sensors = None
    kinds = [(simulated, script_in_motion, script) for simulated in (True, False)
             for script in ('timed_out_and_back.py', 'odom_out_and_back.py')]
    kinds.append((False, filter_in_use))
    for number in range(row.times):
        simulated, fault, *arguments = kinds[(number + row.times) % len(kinds)]
        clock = Time(row, simulated)
        jump = clock.disturb if simulated else lambda: clock.step(row.random.choice([-3600, 3600]))
        text = ' '.join(['simulated' if simulated else 'system', 'time', fault.__name__, *arguments])
        with row.fault(text):
            fault(row, clock, jump, *arguments)
        row.end(*row.processes[1:])
        del row.processes[1:]
        clock.done.set()
        clock.publisher.unregister()
