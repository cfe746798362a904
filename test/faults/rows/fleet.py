"""A fleet on one clock: a robot is removed, or its driver is killed or suspended, while the others drive."""
import signal
import time

from diagnostic_msgs.srv import AddDiagnostics
import rospy
from std_srvs.srv import Empty

from rbx1_nav.node import resources
from rbx1_nav.node.config import load_yaml
import support

FAULT = ('one of three robots of a fleet, which all drive, is removed, or its driver is killed, or suspended for good, '
         'at a random moment; half of the faults beside four busy loops')
PROMISE = 'the two others end at the exact pose; a suspended driver is named; a robot can be added again'
FULL, SHORT = 60, 3
ROOT, ALONE = False, True

LOOPS = 4


def check_exact(truth):
    """Assert that a robot is where the exercise ends on the ideal surface."""
    x, y, yaw = support.pose(truth.next())
    error = max(abs(x - support.EXACT_X), abs(y - support.EXACT_Y), abs(support.wrapped(yaw - support.EXACT_TURN)))
    assert error < support.MICROMETRE, f'{error:g} m or rad off'


def disturb(row, kind, driver, fleet):
    """Remove robot3 or disturb its driver, while all robots drive."""
    time.sleep(row.random.uniform(0, 1.5))
    if kind == 'removed':
        answer = rospy.ServiceProxy('/fleet/remove', AddDiagnostics)('robot3')
        assert answer.success, answer.message
    elif kind == 'killed':
        driver.signal(signal.SIGKILL)
    else:
        before = fleet.output.count('/robot3/out_and_back did not become idle')
        driver.signal(signal.SIGSTOP)
        support.wait_for(lambda: fleet.output.count('/robot3/out_and_back did not become idle') > before or
                         driver.process.poll() is not None, 'the suspended driver to be named')


def run(row):
    """See FAULT."""
    row.roscore()
    fleet = row.start('roslaunch', '--wait', 'rbx1_nav', 'fleet.launch', 'n:=3', 'model:=none', 'real_time_factor:=10')
    fleet.wait_for_line('Ready: 3 robots')
    support.init_node('faults')
    names = ['robot1', 'robot2', 'robot3']
    truth = {name: support.Watch(f'/{name}/ground_truth', support.Odometry) for name in names}
    rospy.set_param('/robot3/arbotix', load_yaml(resources.path('config', 'turtlebot.yaml')))
    for number in range(row.times):
        kind = ('removed', 'killed', 'suspended')[number % 3]
        with row.fault(f'{kind} ({number})'):
            for name in names:
                rospy.ServiceProxy(f'/{name}/arbotix/reset', Empty)()
            with row.busy(LOOPS * (number // 3 % 2)):
                drivers = {name: row.start('rosrun', 'rbx1_nav', 'timed_out_and_back.py', ROS_NAMESPACE=name)
                           for name in names}
                drivers['robot3'].wait_for_line('Connected to ')
                disturb(row, kind, drivers['robot3'], fleet)
                for name in 'robot1', 'robot2':
                    assert drivers[name].wait() == 0, f'{drivers[name].output}\n{fleet.output[-2000:]}'
                    check_exact(truth[name])
                drivers['robot3'].kill()
            if kind == 'removed':
                answer = rospy.ServiceProxy('/fleet/add', AddDiagnostics)('robot3')
                assert answer.success, answer.message
