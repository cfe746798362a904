#!/usr/bin/python3
"""Drivers as people write them, all on the clock: each takes the same path in every run.

    any_driver.py KIND [ARGUMENT]

They do not wait for the time, or for the base, unless their shape does so. The function of a KIND describes its shape.
"""
import sys
import threading
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


def connect(publisher):
    """Wait for the base, as the page recommends."""
    while not publisher.get_num_connections():
        rospy.sleep(0.1)
    rospy.sleep(1)


# the start of a driver

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
    """To a relay: a Rate before the wait for a connection."""
    publisher, rate = advertise(topic), rospy.Rate(10)
    while publisher.get_num_connections() < 1:
        time.sleep(0.1)
    loop(publisher, rate)


# while it drives

def at_rate(rate):
    """A Rate loop at some Hz."""
    publisher = advertise()
    connect(publisher)
    loop(publisher, rospy.Rate(float(rate)))


def sleeps(rate):
    """rospy.sleep() between two commands."""
    publisher = advertise()
    connect(publisher)
    for number in range(COUNT):
        publisher.publish(command(number))
        rospy.sleep(1 / float(rate))
    stop(publisher)


def timer(rate):
    """A rospy.Timer."""
    publisher, numbers, done = advertise(), iter(range(COUNT)), threading.Event()
    connect(publisher)

    def on_timer(_):
        number = next(numbers, None)
        if number is None:
            done.set()
        else:
            publisher.publish(command(number))
    rospy.Timer(rospy.Duration(1 / float(rate)), on_timer)
    done.wait()
    stop(publisher)


def odom_callback(every='1'):
    """A command in each callback of the odometry, or in each second one."""
    publisher, done, count = advertise(), threading.Event(), [-1]
    connect(publisher)

    def on_odom(_):
        count[0] += 1
        if count[0] < COUNT * int(every):
            if count[0] % int(every) == 0:
                publisher.publish(command(count[0] // int(every)))
        elif not done.is_set():
            publisher.publish(Twist())
            done.set()
    rospy.Subscriber('odom', Odometry, on_odom, queue_size=1)
    done.wait()
    rospy.sleep(0.5)


def transform_loop():
    """A Rate loop with the latest transform, after a wait."""
    import tf2_ros
    publisher, buffer = advertise(), tf2_ros.Buffer()
    listener = tf2_ros.TransformListener(buffer)
    connect(publisher)
    rate = rospy.Rate(20)
    while True:
        x = buffer.lookup_transform('odom', 'base_footprint', rospy.Time(0)).transform.translation.x
        if x > 0.3:
            break
        publisher.publish(twist(0.1 + 0.5 * (0.3 - x), x))
        rate.sleep()
    stop(publisher)
    return listener


def transform_callback():
    """A command in each callback of /tf, if it has the robot's frame."""
    from tf2_msgs.msg import TFMessage
    publisher, done, count = advertise(), threading.Event(), [-1]
    connect(publisher)

    def on_transforms(message):
        if not any(each.child_frame_id == 'base_footprint' for each in message.transforms):
            return
        count[0] += 1
        if count[0] <= COUNT:
            publisher.publish(command(count[0]) if count[0] < COUNT else Twist())
        if count[0] == COUNT:
            done.set()
    rospy.Subscriber('/tf', TFMessage, on_transforms)
    done.wait()
    rospy.sleep(0.5)


def several_publishers():
    """Two publishers of the topic in one node, and one of another topic."""
    first, second, other = advertise(), advertise('/cmd_vel'), advertise('elsewhere')
    connect(first)
    rate = rospy.Rate(10)
    for number in range(COUNT):
        (first if number % 2 else second).publish(command(number))
        other.publish(command(number))
        rate.sleep()
    stop(first)


def waits_for_message():
    """It waits for one message of the odometry before it drives."""
    publisher = advertise()
    rospy.wait_for_message('odom', Odometry)
    connect(publisher)
    loop(publisher, rospy.Rate(10))


def parameter():
    """It asks the master for a parameter before each command."""
    publisher = advertise()
    connect(publisher)
    rate = rospy.Rate(10)
    for number in range(COUNT):
        factor = rospy.get_param('~factor', 1.0)
        publisher.publish(twist(factor * (0.1 + 0.01 * number)))
        rate.sleep()
    stop(publisher)


def with_settings(name):
    """A Rate loop with other settings of the publisher."""
    settings = {'latched': dict(latch=True), 'unqueued': dict(queue_size=None), 'queue_1': dict(queue_size=1),
                'no_delay': dict(tcp_nodelay=True)}
    publisher = advertise(**settings[name])
    connect(publisher)
    loop(publisher, rospy.Rate(25))


def motions():
    """Several short motions with rests, a Rate each."""
    publisher = advertise()
    connect(publisher)
    for number in range(4):
        rate = rospy.Rate(20)
        for _ in range(5 + number):
            publisher.publish(command(number))
            rate.sleep()
        publisher.publish(Twist())
        rospy.sleep(0.33)
    stop(publisher)


def durations():
    """A loop until a duration of ROS time is over."""
    publisher = advertise()
    connect(publisher)
    begin, rate, number = rospy.Time.now(), rospy.Rate(15), 0
    while rospy.Time.now() - begin < rospy.Duration(1.5):
        publisher.publish(command(number))
        number += 1
        rate.sleep()
    stop(publisher)


def thread():
    """A thread drives, and the main thread spins."""
    publisher = advertise()

    def drive():
        connect(publisher)
        loop(publisher, rospy.Rate(10))
        rospy.signal_shutdown('done')
    threading.Thread(target=drive).start()
    rospy.spin()


def computes():
    """It computes for some milliseconds of wall time before each command."""
    publisher = advertise()
    connect(publisher)
    rate = rospy.Rate(20)
    for number in range(COUNT):
        sum(range(200000))
        publisher.publish(command(number))
        rate.sleep()
    stop(publisher)


def reads_odom():
    """A Rate loop with the latest odometry."""
    publisher, poses = advertise(), []
    rospy.Subscriber('odom', Odometry, poses.append)
    connect(publisher)
    rate = rospy.Rate(20)
    while poses[-1].pose.pose.position.x < 0.3:
        x = poses[-1].pose.pose.position.x
        publisher.publish(twist(0.1 + 0.5 * (0.3 - x), x))
        rate.sleep()
    stop(publisher)


def one_command():
    """Each command is in force for a while, without a repetition."""
    publisher = advertise()
    connect(publisher)
    for number in range(3):
        publisher.publish(command(number))
        rospy.sleep(0.4)
    stop(publisher)


def main(kind, *arguments):
    """Drive."""
    rospy.init_node(kind.lower(), anonymous=kind not in ('sleeps', 'timer', 'early'))
    globals()[kind](*arguments)


if __name__ == '__main__':
    main(*[arg for arg in sys.argv[1:] if ':=' not in arg])
