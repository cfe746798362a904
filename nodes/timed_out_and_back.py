#!/usr/bin/env python3
"""Out and back, by time alone: forward 1 m, turn left 180 degrees, and the same again.

usage: timed_out_and_back.py [_parameter:=value ...] [topic:=new_topic ...]
example: rosrun rbx1_nav timed_out_and_back.py _goal_distance:=0.5

Parameters:
    ~rate               commands per second, Hz (default: 50)
    ~linear_speed       forward speed, m/s (default: 0.2)
    ~goal_distance      length of the way out, m (default: 1)
    ~angular_speed      turning speed, rad/s (default: 1)
    ~goal_angle         angle of a turn to the left, rad (default: pi)
    ~wait_timeout       how long to wait for roscore, and for a base that subscribes to /cmd_vel, s (default: 30)

The script never asks where the robot is. Drive at a known speed for a known time, and it should end where it began.
"""
import rbx1_nav.ros.node.early_interrupt     # Ctrl-C ends the node quietly even while the rest is loaded

from math import pi
import time

import rospy
from geometry_msgs.msg import Twist
from tqdm import tqdm

from rbx1_nav.control.motions import out_and_back
from rbx1_nav.ros.driving.rate import Rate, pause
from rbx1_nav.ros.driving.waiting import wait_for_subscribers
from rbx1_nav.ros.node import life
from rbx1_nav.ros.node.params import positive_param


class OutAndBack:
    """Drives the robot once out and back; creating one runs it."""

    def __init__(self):
        # Start the node under this name. From here on Ctrl-C leads to stop() below.
        life.init_node('out_and_back', __doc__)

        # How often to publish a command, in Hz. Some robots stop when they receive none, so publish on every tick.
        self.rate = positive_param('rate', 50, 2, 1000)

        # Distance is speed times time: what to cover, and how fast, gives the number of ticks.
        motions = out_and_back(
            linear_speed=positive_param('linear_speed', 0.2),       # m/s
            goal_distance=positive_param('goal_distance', 1.0),     # m
            angular_speed=positive_param('angular_speed', 1.0),     # rad/s
            goal_angle=positive_param('goal_angle', pi),            # rad
            rate=self.rate)
        wait_timeout = positive_param('wait_timeout', 30)           # s

        # The robot's base subscribes to this topic. With a queue, a slow subscriber does not hold up the others.
        self.cmd_vel = rospy.Publisher('/cmd_vel', Twist, queue_size=5)

        try:
            # What is published before anyone subscribes is lost.
            self.listeners = wait_for_subscribers(self.cmd_vel, wait_timeout)

            for motion in motions:
                self.drive(motion)
                # Stop, and come to rest, before the next motion.
                self.cmd_vel.publish(Twist())
                pause(1, self.listeners)

            self.cmd_vel.publish(Twist())
        finally:
            # However it ended: the most important thing that a mobile robot must do.
            self.stop()

        # Say so if the base did not get every command.
        self.listeners.check_delivery()
        rospy.loginfo('Done: commanded %.2f m forward and %.2f rad to the left. To see where that led: '
                      'rosrun rbx1_nav pose.py',
                      sum(motion.ticks * motion.linear for motion in motions) / self.rate,
                      sum(motion.ticks * motion.angular for motion in motions) / self.rate)

    def drive(self, motion):
        """One motion: the same command on every tick, for a number of ticks."""
        command = Twist()
        command.linear.x = motion.linear        # forward, m/s
        command.angular.z = motion.angular      # to the left, rad/s

        speed, unit = (motion.linear, 'm') if motion.linear else (motion.angular, 'rad')
        rospy.loginfo('%s: %.2f %s at %g %s/s', motion.name, motion.ticks * speed / self.rate, unit, speed, unit)

        # With disable=None, tqdm shows its progress bar only in a terminal.
        ticks = tqdm(range(motion.ticks), desc=motion.name, disable=None,
                     bar_format='{desc:9}: |{bar}| {n} of {total} commands')
        rate = Rate(self.rate, self.listeners)
        for _ in ticks:
            self.cmd_vel.publish(command)
            rate.sleep()

    def stop(self):
        """Stop the robot, and give it the time to do so."""
        self.cmd_vel.publish(Twist())
        rospy.loginfo('Stopping the robot...')
        time.sleep(1)   # wall time: a simulated clock may have stopped


if __name__ == '__main__':
    status = 0
    try:
        OutAndBack()
    except rospy.ROSInterruptException:
        rospy.loginfo('Out-and-Back node terminated.')
    except (rospy.ROSException, ValueError) as error:
        rospy.logerr('%s', error)
        status = 1
    life.leave(status)
