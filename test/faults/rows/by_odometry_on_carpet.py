"""The script that measures its pose, in lockstep on carpet: one end pose, also on a busy machine."""
import os

import rosgraph
import rospy
from nav_msgs.msg import Odometry
from roslib.packages import get_pkg_dir
import yaml

from rbx1_nav.robot.description import read_robot
from rbx1_nav.ros.node import resources
from rbx1_nav.simulation.exercise import simulate
from rbx1_nav.simulation.surfaces import load_surface
from rows.feedback import BUSY, load
import support

FAULT = ('odom_out_and_back.py on low_ply_carpet at real_time_factor 20, in the frame odom, and in odom_combined with '
         'the filter, all nodes new for each run; in every second run beside four busy loops')
PROMISE = ('in odom: the end pose that simulate.py computes; in odom_combined: one end pose, if filter and script '
           'begin at the same ticks')
FULL, SHORT = 20, 1     # runs in each frame
ROOT, ALONE = False, True

SURFACE, SEED = 'low_ply_carpet', 7
BASE = 'real_time_factor:=20', 'strict:=true', 'model:=none', f'surface:={SURFACE}', f'seed:={SEED}'
GATE = os.path.join(os.path.dirname(support.__file__), 'faults/gate.py')
# The noise of the gyro depends on the number of ticks since the start of the base, and the estimated bias on the number
# of ticks at rest since the start of the filter: a single tick changes the end pose by about 0.1 mm. So gate.py makes
# them equal in all runs.
TOPICS = {'/gated/odom', '/gated/imu', '/gated/tf', '/odom'}    # of the filter, the script and the gate
FILTER = '''<launch>
  <remap from="odom" to="gated/odom"/>
  <include file="$(find rbx1_bringup)/launch/odom_ekf.launch">
    <arg name="imu" value="gated/imu"/>
    <arg name="surface" value="%s"/>
  </include>
</launch>'''


def run(row):
    """See FAULT."""
    row.roscore()
    support.init_node('faults')
    with open('filter.launch', 'w', encoding='utf-8') as file:
        file.write(FILTER % SURFACE)
    with open(os.path.join(get_pkg_dir('rbx1_nav'), 'config/turtlebot.yaml'), encoding='utf-8') as file:
        robot = read_robot(yaml.safe_load(file))
    truth = simulate('odom', robot, load_surface(SURFACE, resources.surfaces()), SEED).end.truth
    # as in a message, which has no turns
    ends = {'odom': (truth.x, truth.y, support.wrapped(truth.yaw))}
    for frame in 'odom', 'odom_combined':
        for number in range(row.times):
            loops = number % 2 * BUSY
            with row.fault(f'{frame}, {loops} busy loops'), load(row, loops):
                end = drive(row, frame)
                expected = ends.setdefault(frame, end)
                # the message has a quaternion instead of the yaw, and the filter computes in the order of its messages
                off = max(abs(a - b) for a, b in zip(end[:2], expected)), abs(support.wrapped(end[2] - expected[2]))
                row.figure(f'difference of the end poses in {frame} (m, rad)', max(off))
                assert max(off) < support.MICROMETRE, f'{end}, expected {expected}'


def drive(row, frame):
    """Start everything, drive, and return the true end pose."""
    nodes = []
    try:
        if frame == 'odom':
            nodes += [row.base(*BASE), row.node('odom_out_and_back.py')]
            driver = nodes[-1]
        else:       # the base comes last: its clock begins when they are all connected
            rospy.set_param('/use_sim_time', True)
            nodes += [row.start(GATE), row.start('roslaunch', '--wait', os.path.abspath('filter.launch'))]
            driver = row.node('odom_out_and_back.py', f'_odom_frame:={frame}', '/tf:=gated/tf', '_wait_timeout:=600')
            nodes.append(driver)
            driver.wait_for_line('Waiting for ')
            support.wait_for(lambda: TOPICS <= {topic for topic, _ in rosgraph.Master('/faults').getSystemState()[1]},
                             f'subscribers of {TOPICS}')
            nodes.append(row.base(*BASE))
        support.wait_for(lambda: any(node.process.poll() is not None for node in nodes), 'the end of the script')
        assert driver.process.poll() == 0, '\n\n'.join(node.output[-500:] for node in nodes)
        return support.pose(rospy.wait_for_message('/ground_truth', Odometry, support.LIMIT))
    finally:
        row.end(*reversed(nodes))
