#!/usr/bin/env python3
"""Out and back, by time alone: forward 1 m, turn left 180 degrees, and the same again.

Nobody asks the robot where it is. Drive at a known speed for a known time, and it should end where it began.
"""
from math import pi
import time

import rospy
from geometry_msgs.msg import Twist
from tqdm import tqdm

from rbx1_nav import driver, node
from rbx1_nav.maneuver import out_and_back


class OutAndBack:
    """Drives the robot once out and back; making one is running it."""

    def __init__(self):
        # Join ROS under this name. From here on Ctrl-C leads to stop() below.
        node.init_node('out_and_back')

        # How often to say what to do, in Hz. Some robots stop when they hear nothing, so say it on every tick.
        self.rate = driver.positive_param('rate', 50)

        # Speed times time is distance: what we want to cover, and how fast, gives the number of ticks.
        motions = out_and_back(
            linear_speed=driver.positive_param('linear_speed', 0.2),    # m/s
            goal_distance=driver.positive_param('goal_distance', 1.0),  # m
            angular_speed=driver.positive_param('angular_speed', 1.0),  # rad/s
            goal_angle=driver.positive_param('goal_angle', pi),         # rad
            rate=self.rate)
        wait_timeout = driver.positive_param('wait_timeout', 30)        # s

        # The robot's base listens here. A queue lets a slow listener lag behind without holding up the others.
        self.cmd_vel = rospy.Publisher('/cmd_vel', Twist, queue_size=5)

        try:
            # What is said before anyone listens is lost.
            driver.wait_for_subscribers(self.cmd_vel, wait_timeout)

            for motion in motions:
                self.drive(motion)
                # Stop, and come to rest, before the next motion.
                self.cmd_vel.publish(Twist())
                driver.pause(1, self.cmd_vel)

            self.cmd_vel.publish(Twist())
        finally:
            # However it ended: the one thing a mobile robot must do.
            self.stop()

    def drive(self, motion):
        """One motion: the same command on every tick, for as many ticks as it takes."""
        command = Twist()
        command.linear.x = motion.linear        # forward, m/s
        command.angular.z = motion.angular      # to the left, rad/s

        speed, unit = (motion.linear, 'm') if motion.linear else (motion.angular, 'rad')
        rospy.loginfo('%s: %.2f %s at %g %s/s', motion.name, motion.ticks * speed / self.rate, unit, speed, unit)

        # The bar is for people: tqdm leaves it out where nobody looks (disable=None).
        ticks = tqdm(range(motion.ticks), desc=motion.name, unit_scale=speed / self.rate, unit=unit, disable=None,
                     bar_format='{desc:9}: |{bar}| {n_fmt} of {total_fmt} {unit}')
        rate = driver.Rate(self.rate, self.cmd_vel)
        for _ in ticks:
            self.cmd_vel.publish(command)
            rate.sleep()

    def stop(self):
        """Tell the robot to stop, and give it the time to do so."""
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
    node.leave(status)
