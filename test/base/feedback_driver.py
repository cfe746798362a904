#!/usr/bin/python3
"""A driver with feedback: it drives to x = 1 m, slower near the goal, and stops there.

    feedback_driver.py KIND RATE [wall]

KIND: latest         a rospy.Rate loop with the latest /odom
      latest_ekf     a rospy.Rate loop with the latest /odom_ekf
      tf_loop        a rospy.Rate loop with the latest transform
      callback       answers every (50 // RATE)-th /odom in its callback
      tf_callback    like callback, with the transform at the stamp of the message
      filters        like callback, for pairs of /odom and /imu/data
RATE: Hz; wall: waits for the base on wall time. Exits with status 1 if there is no transform at a stamp.
"""
import math
import sys
import threading
import time

import rospy
from geometry_msgs.msg import Twist
from nav_msgs.msg import Odometry
from sensor_msgs.msg import Imu

ODOM_RATE = 50      # Hz


def command(position, rotation):
    """Return the Twist at a pose: towards x = 1 m, and gently towards the line y = 0.05 m; None at the goal."""
    if position.x >= 0.999:
        return None
    twist = Twist()
    twist.linear.x = min(max(1.0 * (1.0 - position.x), 0.05), 0.3)
    twist.angular.z = 0.5 * (0.05 - position.y) - 0.5 * 2 * math.atan2(rotation.z, rotation.w)
    return twist


class Driver:
    """Subscribes when it is created, and drives when drive() is called."""

    def __init__(self, kind, rate):
        self.kind = kind
        self.rate = rate
        self.odom = None        # the latest message
        self.count = None       # number of messages since the driving began; None: not driving
        self.done = threading.Event()
        self.failure = None
        if 'tf' in kind:
            import tf2_ros      # here, because the import takes longer than a run
            self.buffer = tf2_ros.Buffer()
            self.listener = tf2_ros.TransformListener(self.buffer)
        if kind == 'filters':
            import message_filters      # here, because it need not be installed
            self.pairs = message_filters.TimeSynchronizer([message_filters.Subscriber('/odom', Odometry),
                                                           message_filters.Subscriber('/imu/data', Imu)], 10)
            self.pairs.registerCallback(lambda odom, _: self.on_odom(odom))
        else:
            rospy.Subscriber('/odom_ekf' if kind == 'latest_ekf' else '/odom', Odometry, self.on_odom)
        self.publisher = rospy.Publisher('/cmd_vel', Twist, queue_size=10)

    def is_ready(self):
        """Return whether the base listens, and there is a pose."""
        return self.publisher.get_num_connections() > 0 and self.odom and (
            'tf' not in self.kind or self.buffer.can_transform('odom', 'base_footprint', rospy.Time(0)))

    def pose(self, time):
        """Return position and rotation; time: of the transform."""
        if 'tf' in self.kind:
            transform = self.buffer.lookup_transform('odom', 'base_footprint', time).transform
            return transform.translation, transform.rotation
        return self.odom.pose.pose.position, self.odom.pose.pose.orientation

    def step(self, time):
        """Send the command for a pose; at the goal, stop and set `done`."""
        twist = command(*self.pose(time))
        self.publisher.publish(twist or Twist())
        if not twist:
            self.done.set()

    def on_odom(self, odom):
        """Store a message; the kinds with a callback answer it."""
        self.odom = odom
        if self.count is None or self.done.is_set():
            return
        if self.count % (ODOM_RATE // self.rate) == 0:
            try:
                self.step(odom.header.stamp)
            except Exception as error:      # in a callback, rospy only logs it
                self.failure = f'{type(error).__name__}: {error}'
                self.done.set()
        self.count += 1

    def drive(self):
        """Drive to the goal."""
        if self.kind in ('callback', 'tf_callback', 'filters'):
            self.count = 0
            self.done.wait()
            return
        if self.kind == 'latest_ekf':       # at 10 Hz: with another phase, the same driver takes another path
            first = self.odom
            while self.odom is first:
                rospy.sleep(1 / ODOM_RATE)
        clock = rospy.Rate(self.rate)
        while not self.done.is_set():
            self.step(rospy.Time(0))
            clock.sleep()


def main(kind, rate, start=''):
    """Drive; return the exit status."""
    rospy.init_node('feedback_driver', anonymous=True)
    driver = Driver(kind, int(rate))
    if start == 'wall':
        rospy.wait_for_message('/odom', Odometry)
        while not driver.is_ready():
            time.sleep(0.1)
    else:
        while not driver.is_ready():
            rospy.sleep(0.1)
        rospy.sleep(1)
    driver.drive()
    rospy.sleep(0.2)    # lets the stop be sent
    return driver.failure


if __name__ == '__main__':
    sys.exit(main(*[arg for arg in sys.argv[1:] if ':=' not in arg]))
