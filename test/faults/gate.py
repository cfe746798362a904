#!/usr/bin/python3
"""Makes a filter and a script begin at the same ticks in every run, whenever they are ready.

It passes on /odom and /imu/data as gated/odom and gated/imu from FILTER on, and /tf as gated/tf from SCRIPT on. As a
publisher of /cmd_vel that is not asleep, it holds the clock until the filter listens, and until the script has a pose.
"""
from collections import deque
import sys
import time

import rospy
from geometry_msgs.msg import Twist
from nav_msgs.msg import Odometry
from rosgraph_msgs.msg import Log
from sensor_msgs.msg import Imu
from tf2_msgs.msg import TFMessage

FILTER, SCRIPT = 10, 13     # s of simulated time; the gate needs a few s to connect, and the filter 2 s at rest
STORED = 40     # transforms, at 60 Hz in all: those of the filter and the base at one time are among them
LIMIT = 4   # s of wall time to hold the clock; the base waits for a node for 5 s


class Gate:
    """Passes on the messages of one topic once it is open."""

    def __init__(self, name, kind, gated):
        self.is_open = False
        self.stored = deque(maxlen=STORED)
        self.publisher = rospy.Publisher(gated, kind, queue_size=100, tcp_nodelay=True)
        rospy.Subscriber(name, kind, self.on_message, queue_size=None, tcp_nodelay=True)

    def on_message(self, message):
        """Pass on a message, or store it if it is a transform."""
        if self.is_open:
            self.publisher.publish(message)
        elif isinstance(message, TFMessage):
            self.stored.append(message)

    def open(self):
        """Pass on the stored transforms, and all later messages."""
        self.is_open = True
        for message in self.stored:
            self.publisher.publish(message)

    def has_listener(self):
        """Return whether a node subscribes."""
        return self.publisher.get_num_connections() > 0


def hold(condition, what):
    """Hold the clock until condition() is true."""
    end = time.monotonic() + LIMIT
    while not condition():
        if time.monotonic() > end:
            sys.exit(f'gate: timed out waiting for {what}')


def sleep_until(second):
    """Sleep until the tick at a time, s."""
    while rospy.get_time() < second:
        rospy.sleep(max(second - rospy.get_time(), 0.001))
    if rospy.get_time() > second + 0.05:     # two ticks, as the sleep may end a tick late
        sys.exit(f'gate: awake at {rospy.get_time():g} s, expected {second:g} s')


def main():
    """Open the gates, and run until shutdown is requested."""
    rospy.init_node('gate')
    rospy.Publisher('/cmd_vel', Twist, queue_size=1)
    log = []
    rospy.Subscriber('/rosout', Log, lambda message: log.append(message.msg))
    inputs = [Gate('/odom', Odometry, 'gated/odom'), Gate('/imu/data', Imu, 'gated/imu')]
    transforms = Gate('/tf', TFMessage, 'gated/tf')
    sleep_until(FILTER)
    hold(lambda: all(gate.has_listener() for gate in inputs), 'the filter')
    for gate in inputs:
        gate.open()
    sleep_until(SCRIPT)
    hold(transforms.has_listener, 'the script')
    transforms.open()
    # the script looks for a pose on wall time
    hold(lambda: any('Measuring the pose' in line for line in list(log)), 'the script to find it')
    rospy.spin()


if __name__ == '__main__':
    main()
