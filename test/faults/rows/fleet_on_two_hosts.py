"""A fleet on one clock, with a driver on another host."""
import math

from rows.two_hosts import HOSTS, two_hosts
import support

FAULT = 'a fleet of two robots: one driver runs on the host of the fleet, the other one on another host'
PROMISE = 'the first robot ends at the exact pose; the driver of the second one is named as not in step'
FULL, SHORT = 10, 1
ROOT, ALONE = True, True

POSE = '''
import rospy
from nav_msgs.msg import Odometry
rospy.init_node('pose', anonymous=True, disable_rostime=True)
pose = rospy.wait_for_message('/robot1/ground_truth', Odometry).pose.pose
print('at', pose.position.x, pose.position.y, pose.orientation.z, pose.orientation.w)
'''


def run(row):
    """See FAULT."""
    with two_hosts() as (names, _):
        def start(number, *command, **environment):
            return row.start('ip', 'netns', 'exec', names[number], *command, **environment,
                             ROS_MASTER_URI=f'http://{HOSTS[0]}:11311', ROS_IP=HOSTS[number])
        start(0, 'roscore').wait_for_line('started core service')
        for number in range(row.times):
            with row.fault(f'run {number}'):
                fleet = start(0, 'roslaunch', 'rbx1_nav', 'fleet.launch', 'n:=2', 'model:=none', 'real_time_factor:=5')
                fleet.wait_for_line('Ready: 2 robots')
                drivers = [start(host, 'rosrun', 'rbx1_nav', 'timed_out_and_back.py', ROS_NAMESPACE=f'robot{host + 1}')
                           for host in range(2)]
                assert drivers[0].wait() == 0, drivers[0].output
                drivers[1].wait()
                assert '/robot2/out_and_back runs on another machine' in fleet.output, fleet.output
                assert '/robot1/out_and_back' not in fleet.output, fleet.output
                position = start(0, '/usr/bin/python3', '-c', POSE)
                x, y, *rotation = map(float, position.wait_for_line('at (.*) (.*) (.*) (.*)').groups())
                yaw = 2 * math.atan2(*rotation)
                error = max(abs(x - support.EXACT_X), abs(y - support.EXACT_Y),
                            abs(support.wrapped(yaw - support.EXACT_TURN)))
                assert error < support.MICROMETRE, f'{error:g} m or rad off'
                row.end(fleet)
        row.end()
