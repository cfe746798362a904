"""The system clock steps by an hour, as a driving script or the filter sees it."""
import math
import os
import time

import rospkg
from geometry_msgs.msg import PoseWithCovarianceStamped

import support
from sensors import Sensors

FAULT = 'the system clock of a script or of the filter steps by an hour'
PROMISE = 'finite values, no false success, and no hang'
FULL, SHORT = 12, 3
ROOT = ALONE = False

NODES = os.path.join(rospkg.RosPack().get_path('rbx1_nav'), 'nodes')
SPEED = 0.2     # m/s
NEAR = 0.03     # m and rad: an end that counts as exact in real time
# the node itself, with a time of day that is off by the number in a file
STEPPED = """
import runpy, sys, time
real, (node, offset) = time.time, sys.argv[1:3]
time.time = lambda: real() + float(open(offset).read() or 0)
time.time_ns = lambda: int(time.time() * 1e9)
sys.argv[:3] = [node]
runpy.run_path(node, run_name='__main__')
"""


def step(seconds):
    """Step the system clock of the node that start() starts."""
    with open('offset.new', 'w', encoding='ascii') as file:
        file.write(f'{seconds:+d}')
    os.rename('offset.new', 'offset')


def start(row, node, *arguments):
    """Start a node whose system clock can be stepped."""
    step(0)
    return row.start('/usr/bin/python3', '-c', STEPPED, os.path.join(NODES, node), 'offset', *arguments)


def script_in_motion(row, seconds, script):
    """The clock of a script steps while it drives."""
    row.reset()
    odom = support.OdomWatch()
    driver = start(row, script, '_goal_distance:=0.3', '_goal_angle:=3.14')
    support.wait_for(lambda: odom.last.twist.twist.linear.x > SPEED / 2, 'the start')
    time.sleep(row.random.uniform(0, 2))
    step(seconds)
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


def filter_in_use(row, seconds):
    """The clock of the filter steps while the sensors' stamps go on."""
    start(row, 'ekf.py', 'odom:=/odom_sent')
    poses = support.Watch('/robot_pose_ekf/odom_combined', PoseWithCovarianceStamped)
    if not row.sensors:
        row.sensors = Sensors('/odom_sent')
        row.sensors.start()
    poses.next()
    step(seconds)
    time.sleep(1)
    step(0)
    count = len(poses.messages)
    support.wait_for(lambda: len(poses.messages) > count + 3, 'a pose after the clock is right again')
    assert all(math.isfinite(n) for m in poses.messages for n in [*support.pose(m), *m.pose.covariance]), \
        'a value that is not finite'


def run(row):
    """See FAULT."""
    row.roscore()
    row.base()
    support.init_node('faults')
    row.sensors = None
    kinds = [(script_in_motion, 'timed_out_and_back.py'), (script_in_motion, 'odom_out_and_back.py'), (filter_in_use,)]
    for number in range(row.times):
        fault, *arguments = kinds[number % len(kinds)]
        seconds = row.random.choice([-3600, 3600])
        with row.fault(' '.join([fault.__name__, *arguments, f'{seconds:+d} s'])):
            fault(row, seconds, *arguments)
