#!/usr/bin/python3
"""A typical driver: it sends 0.2 m/s for 1 s at a given rate, then a stop.

    driver_at_rate.py KIND RATE,... [SPEED]

KIND: rate (rospy.Rate), sleep (rospy.sleep), timer (rospy.Timer); RATE: Hz, each after the other, with a line of its
input in between; SPEED: m/s. With SPEED, it reads the simulated time of the first command (s) from its input. Otherwise
it begins 0.3 s of wall time after the base has connected.
"""
import sys
import threading
import time

import rospy
from geometry_msgs.msg import Twist


def drive(kind, rate, count, publisher, move):
    """Send `count` commands, and a stop a period after the last one."""
    if kind == 'timer':
        commands, done = iter([move] * count + [Twist()]), threading.Event()

        def on_timer(_):
            command = next(commands, None)
            if command is None:
                done.set()
            else:
                publisher.publish(command)
        rospy.Timer(rospy.Duration(1 / rate), on_timer)
        done.wait()
        return
    clock = rospy.Rate(rate)
    for _ in range(count):
        publisher.publish(move)
        if kind == 'rate':
            clock.sleep()
        else:
            rospy.sleep(1 / rate)
    publisher.publish(Twist())


def main(kind, rates, speed=None):
    """Drive."""
    rospy.init_node('driver', anonymous=True)
    publisher = rospy.Publisher('/cmd_vel', Twist, queue_size=10)
    # the first /clock message may arrive last on a busy machine; a Rate that begins at time 0 skips its first sleep
    while publisher.get_num_connections() == 0 or rospy.get_time() == 0:
        time.sleep(0.02)
    if speed is None:
        time.sleep(0.3)
    else:
        rospy.sleep(float(input('ready\n')) - rospy.get_time())
    move = Twist()
    move.linear.x = float(speed or 0.2)
    for number, rate in enumerate(map(int, rates.split(','))):
        if number:
            input('rests\n')
            rospy.sleep(0.1)    # begins on the clock
        drive(kind, rate, rate, publisher, move)
        rospy.sleep(0.2)    # lets the stop be sent


if __name__ == '__main__':
    main(*[arg for arg in sys.argv[1:] if ':=' not in arg])
