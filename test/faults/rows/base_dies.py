"""The base dies while the robot moves: no driving script reports success without having reached its end pose."""
from itertools import product
import os
import signal

import rospy
from geometry_msgs.msg import Twist

import support

FAULT = ('SIGKILL to the base during a motion; with and without respawn, a second subscriber, and simulated time, for '
         'both scripts')
PROMISE = 'the script does not exit with 0; its last command is a stop'
FULL, SHORT = 32, 3
ROOT = ALONE = False

FACTOR = 5
LIMIT = 15      # s of wall time in which the script notices; the rest of the longest run takes 16 s
LONGEST = {True: 15, False: 4}      # s of ROS time in which the base dies: on simulated time, or real time
# as a user who wants his base back would start it
BASE = '''<launch>
  <param name="/use_sim_time" value="%(simulated)s"/>
  <rosparam command="load" file="$(find rbx1_nav)/config/turtlebot.yaml" ns="arbotix"/>
  <node name="arbotix" pkg="rbx1_nav" type="fake_base.py" output="screen" respawn="%(respawn)s">
    <param name="real_time_factor" value="%(factor)d" if="%(simulated)s"/>
  </node>
</launch>'''
# (script, whether somebody else listens, respawn, simulated time): those that once ended with success come first
CASES = sorted(product(('timed_out_and_back.py', 'odom_out_and_back.py'), (True, False), (True, False), (True, False)),
               key=lambda case: (not case[1], not case[2]))


def run(row):
    """See FAULT."""
    row.roscore()
    support.init_node('faults')
    for count in range(row.times):
        script, listener, respawn, simulated = CASES[count % len(CASES)]
        moment = row.random.uniform(0, LONGEST[simulated])
        with row.fault('%s, base killed %.3f s after the start of the motion, %s, %s, %s' % (
                script, moment, 'a second subscriber' if listener else 'no other subscriber',
                'respawned' if respawn else 'not respawned', 'simulated time' if simulated else 'real time')):
            kill_base(row, script, moment, listener, dict(respawn=respawn, simulated=simulated, factor=FACTOR))


def kill_base(row, script, moment, listener, settings):
    """One fault. moment: s of ROS time; settings: of BASE."""
    if rospy.has_param('/arbotix'):
        rospy.delete_param('/arbotix')
    with open('base.launch', 'w', encoding='utf-8') as file:
        file.write(BASE % settings)
    base = row.start('roslaunch', os.path.abspath('base.launch'))
    base.wait_for_line('Ready: ')
    odom = support.OdomWatch()
    commands = support.Watch('/cmd_vel', Twist) if listener else None
    driver = row.node(script)
    try:
        start = odom.wait_for_twist(0.2).header.stamp
        support.wait_for(lambda: (odom.last.header.stamp - start).to_sec() >= moment, 'the moment')
        pose = support.pose(odom.last)
        os.kill(support.pid_of('/arbotix'), signal.SIGKILL)
        support.wait_for(lambda: driver.process.poll() is not None, 'the end of the script', LIMIT)
        assert driver.wait() != 0, 'exit status 0; its base died at %.3f m, %.3f m, %.3f rad:\n%s' % (
            *pose, driver.output)
        assert 'Traceback' not in driver.output, driver.output
        if commands:
            support.wait_for(lambda: not commands.subscriber.get_num_connections(), 'the end of the connection')
            assert (commands.last.linear.x, commands.last.angular.z) == (0, 0), 'the last command is not a stop'
    finally:
        row.end(driver, base)
        odom.subscriber.unregister()
        if commands:
            commands.subscriber.unregister()
