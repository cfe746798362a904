#!/usr/bin/python3
"""Drivers as people write them, all on the clock, with various starts: each takes the same path in every run.

    any_driver.py KIND [ARGUMENT]

They do not wait for the time, or for the base, unless their shape does so. The function of a KIND describes its shape.
"""
import sys
import time

import rospy
from geometry_msgs.msg import Twist
from nav_msgs.msg import Odometry

COUNT = 20      # moving commands


def twist(linear, angular=0.0):
    """Return a Twist, m/s and rad/s."""
    message = Twist()
    message.linear.x, message.angular.z = linear, angular
    return message


def command(number):
    """Return a moving Twist, different for each number: the end pose shows each command that is lost or late."""
    return twist(0.1 + 0.01 * number, 0.03 * number)


def advertise(topic='cmd_vel', **settings):
    """Create the publisher."""
    return rospy.Publisher(topic, Twist, **dict(dict(queue_size=10), **settings))


def loop(publisher, rate, count=COUNT):
    """Send commands at a Rate, then stop."""
    for number in range(count):
        publisher.publish(command(number))
        rate.sleep()
    stop(publisher)


def stop(publisher):
    """Stop, and let the stop be sent."""
    publisher.publish(Twist())
    rospy.sleep(0.5)


def early(wait='1'):
    """A Rate before the wait, which is by the wall clock."""
    publisher, rate = advertise(), rospy.Rate(10)
    time.sleep(float(wait))
    loop(publisher, rate)


def connection():
    """A Rate before the wait for a connection, by the wall clock."""
    publisher, rate = advertise(), rospy.Rate(10)
    while publisher.get_num_connections() < 1:
        time.sleep(0.1)
    loop(publisher, rate)


def spinning():
    """The wait for a connection does not sleep at all."""
    publisher, rate = advertise(), rospy.Rate(10)
    while publisher.get_num_connections() < 1 and not rospy.is_shutdown():
        pass
    loop(publisher, rate)


def no_wait():
    """It waits for nothing: the first command is lost in every run."""
    loop(advertise(), rospy.Rate(10))


def first_odom():
    """A Rate before the wait for odometry."""
    publisher, rate, poses = advertise(queue_size=5), rospy.Rate(10), []
    rospy.Subscriber('odom', Odometry, poses.append)
    while not poses:
        rospy.sleep(0.01)
    loop(publisher, rate)


def first_transform():
    """A Rate before the wait for a transform."""
    import tf
    publisher, rate = advertise(queue_size=5), rospy.Rate(10)
    listener = tf.TransformListener()
    listener.waitForTransform('odom', 'base_footprint', rospy.Time(), rospy.Duration(1.0))
    loop(publisher, rate)


class GoToPoint:
    """As the point operation of turtlebot3: a transform decides which command is next."""

    def __init__(self, goal=0.5):
        import tf
        self.publisher = advertise(queue_size=5)
        rate = rospy.Rate(10)
        self.listener = tf.TransformListener()
        self.listener.waitForTransform('odom', 'base_footprint', rospy.Time(), rospy.Duration(1.0))
        rospy.on_shutdown(lambda: self.publisher.publish(Twist()))
        while True:
            (x, y, _), _ = self.listener.lookupTransform('odom', 'base_footprint', rospy.Time(0))
            if x > goal:
                break
            self.publisher.publish(twist(min(0.3, max(0.05, goal - x)), 0.3 * (0.1 - y)))
            rate.sleep()
        stop(self.publisher)


class Square:
    """A class that drives a square, as many tutorials do: the Rate and a wall-time sleep in its constructor."""

    def __init__(self):
        self.publisher = advertise(queue_size=1)
        self.rate = rospy.Rate(10)
        rospy.on_shutdown(lambda: self.publisher.publish(Twist()))
        time.sleep(2)
        for _ in range(4):
            for message, count in (twist(0.2), 10), (twist(0.0, 0.785), 20):
                for _ in range(count):
                    self.publisher.publish(message)
                    self.rate.sleep()
        stop(self.publisher)


def exercise():
    """The exercise in plain rospy: waits for its connection by the wall clock, then legs, stops and rests."""
    publisher = advertise(queue_size=5)
    while not publisher.get_num_connections() and not rospy.is_shutdown():
        time.sleep(0.1)
    for _ in range(2):
        for message, duration in (twist(0.2), 1.0), (twist(0.0, 1.0), 1.5):
            rate = rospy.Rate(50)
            for _ in range(int(duration * 50)):
                publisher.publish(message)
                rate.sleep()
            publisher.publish(Twist())
            rospy.sleep(1)


def late(wait='2'):
    """A publisher that is created after a while, and used at once: the first command is lost in every run."""
    rospy.sleep(float(wait))
    publisher = advertise()
    loop(publisher, rospy.Rate(10))


def through(topic):
    """To a relay, with the start that the page recommends: the base does not order the connection to a relay."""
    publisher = advertise(topic)
    while not publisher.get_num_connections():
        rospy.sleep(0.1)
    rospy.sleep(1)
    loop(publisher, rospy.Rate(10))


def main(kind, *arguments):
    """Drive."""
    rospy.init_node(kind.lower(), anonymous=kind != 'early')
    globals()[kind](*arguments)


if __name__ == '__main__':
    main(*[arg for arg in sys.argv[1:] if ':=' not in arg])
