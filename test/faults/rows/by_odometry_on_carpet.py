"""The script that measures its pose, in lockstep on carpet: it ends where simulate.py computes."""
from nav_msgs.msg import Odometry
import rospy

from rbx1_nav.base.robot_parameters import load_robot
from rbx1_nav.base.surfaces import load_surface
from rbx1_nav.extras.many_runs.simulated_run import simulate
from rbx1_nav.node import resources
import support

FAULT = ('odom_out_and_back.py on low_ply_carpet at real_time_factor 20, with a new base for each run; in every second '
         'run beside four busy loops')
PROMISE = 'the end pose that simulate.py computes for the seed'
FULL, SHORT = 20, 2
ROOT, ALONE = False, True

BUSY = 4        # loops
SURFACE, SEED = 'low_ply_carpet', 7
BASE = 'real_time_factor:=20', 'strict:=true', 'model:=none', f'surface:={SURFACE}', f'seed:={SEED}'


def run(row):
    """See FAULT."""
    row.roscore()
    support.init_node('faults')
    robot = load_robot(resources.path('config', 'turtlebot.yaml'))
    truth = simulate('odom', robot, load_surface(SURFACE, resources.surfaces()), SEED).end.truth
    for number in range(row.times):
        loops = number % 2 * BUSY
        with row.fault(f'{loops} busy loops'), row.busy(loops):
            base, driver = row.base(*BASE), row.node('odom_out_and_back.py')
            try:
                assert driver.wait() == 0, driver.output
                x, y, yaw = support.pose(rospy.wait_for_message('/ground_truth', Odometry, support.LIMIT))
            finally:
                row.end(driver, base)
            assert (x, y) == (truth.x, truth.y), f'{(x, y)}, expected {truth}'
            # the message has a quaternion instead of the yaw
            assert abs(support.wrapped(yaw - truth.yaw)) < 1e-9, f'{yaw}, expected {truth.yaw}'
