#!/usr/bin/env python3
"""Out and back by odometry: forward 1 m, turn left 180 degrees, and the same again, asking the robot how far it is.

The robot's wheels count how far they turn, and its base makes a position of that: the transform from the frame odom to
the frame of the base. So do not drive for a time: drive until you are there.
"""
from math import pi
import time

import rospy
from geometry_msgs.msg import Twist

from rbx1_nav import driver, node
from rbx1_nav.maneuver import out_and_back_by_odometry
from rbx1_nav.whereabouts import LostTransform, Whereabouts


class OutAndBack:
    """Drives the robot once out and back; making one is running it."""

    def __init__(self):
        # Join ROS under this name. From here on Ctrl-C leads to stop() below.
        node.init_node('out_and_back')

        # How often to look, and to say what to do, in Hz.
        self.rate = driver.positive_param('rate', 50)

        # How far to go, and how fast. Near the goal it goes slower and slower, down to the least speed that moves it.
        legs = out_and_back_by_odometry(
            linear_speed=driver.positive_param('linear_speed', 0.2),            # m/s
            goal_distance=driver.positive_param('goal_distance', 1.0),          # m
            angular_speed=driver.positive_param('angular_speed', 1.0),          # rad/s
            goal_angle=driver.positive_param('goal_angle', pi),                 # rad
            rate=self.rate,
            min_linear_speed=driver.positive_param('min_linear_speed', 0.05),   # m/s
            min_angular_speed=driver.positive_param('min_angular_speed', 0.2))  # rad/s
        wait_timeout = driver.positive_param('wait_timeout', 30)                # s
        self.transform_timeout = driver.positive_param('transform_timeout', 5)  # s

        # Where the robot is: its base, which some call base_footprint and some base_link, in the frame of its odometry.
        self.whereabouts = Whereabouts(driver.frame_param('odom_frame', 'odom'),
                                       driver.frame_param('base_frame', None))

        # The robot's base listens here. A queue lets a slow listener lag behind without holding up the others.
        self.cmd_vel = rospy.Publisher('/cmd_vel', Twist, queue_size=5)

        try:
            # What is said before anyone listens is lost.
            driver.wait_for_subscribers(self.cmd_vel, wait_timeout)
            self.whereabouts.wait(wait_timeout)

            for leg in legs:
                self.drive(leg)
                # Stop, and come to rest, before the next leg.
                self.cmd_vel.publish(Twist())
                driver.pause(1, self.cmd_vel)

            self.cmd_vel.publish(Twist())
        finally:
            # However it ended: the one thing a mobile robot must do.
            self.stop()

    def drive(self, leg):
        """One leg: look where the robot is, and go on, until it is there."""
        rospy.loginfo('%s: %.2f %s', leg.name, leg.goal, leg.unit)
        rate = driver.Rate(self.rate, self.cmd_vel)
        command = Twist()
        speed = leg.next_speed(self.where())
        while speed:
            command.linear.x, command.angular.z = leg.velocity(speed)
            self.cmd_vel.publish(command)
            rate.sleep()
            speed = leg.next_speed(self.where())

    def where(self):
        """The robot's pose. As long as nobody knows it, the robot stands."""
        try:
            return self.whereabouts.pose()
        except LostTransform as error:
            self.cmd_vel.publish(Twist())
            rospy.logwarn('%s: the robot waits for a new one', error)
            return self.whereabouts.wait(self.transform_timeout)

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
    except (rospy.ROSException, ValueError) as error:     # or stuck
        rospy.logerr('%s', error)
        status = 1
    node.leave(status)
