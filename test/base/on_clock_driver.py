#!/usr/bin/python3
"""Drivers as people write them, all on the clock, with the start that the page recommends: each takes the same path in
every run.

    on_clock_driver.py KIND [ARGUMENT]

The function of a KIND describes it.
"""
import sys
import threading

import rospy
from geometry_msgs.msg import Twist
from nav_msgs.msg import Odometry

from any_driver import COUNT, advertise, command, loop, stop, twist


def connect(publisher):
    """Wait for the base, as the page recommends."""
    while not publisher.get_num_connections():
        rospy.sleep(0.1)
    rospy.sleep(1)


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
    rospy.init_node(kind, anonymous=kind not in ('sleeps', 'timer'))
    globals()[kind](*arguments)


if __name__ == '__main__':
    main(*[arg for arg in sys.argv[1:] if ':=' not in arg])
