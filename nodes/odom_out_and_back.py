#!/usr/bin/env python3
"""Out and back by odometry: forward 1 m, turn left 180 degrees, and the same again, measured by the robot's pose.

usage: odom_out_and_back.py [_parameter:=value ...] [topic:=new_topic ...]
example: rosrun rbx1_nav odom_out_and_back.py _odom_frame:=odom_combined

Parameters:
    ~rate               commands per second, Hz (default: 50)
    ~linear_speed       forward speed, m/s (default: 0.2)
    ~goal_distance      length of the way out, m (default: 1)
    ~angular_speed      turning speed, rad/s (default: 1)
    ~goal_angle         angle of a turn to the left, rad (default: pi)
    ~min_linear_speed   lowest speed near the goal, m/s; less may not move your robot (default: 0.05)
    ~min_angular_speed  the same in a turn, rad/s (default: 0.2)
    ~odom_frame         frame that the pose is measured in; odom_combined: by wheels and gyro (default: odom)
    ~base_frame         frame of the robot (default: base_footprint or base_link, whichever exists)
    ~wait_timeout       how long to wait for roscore, for a base on /cmd_vel, and for its pose, s (default: 30)
    ~transform_timeout  how long the robot stands and waits if its pose is lost, s (default: 5)

The base counts how far its wheels turn, and publishes a pose: the transform from the frame odom to its own frame. So do
not drive for a time: drive until you are there.
"""
import rbx1_nav.ros.node.early_interrupt     # Ctrl-C ends the node quietly even while the rest is loaded

from math import degrees, hypot, pi
import time

import rospy
from geometry_msgs.msg import Twist
from tqdm import tqdm

from rbx1_nav.control.legs import out_and_back_by_odometry
from rbx1_nav.ros.driving.pose_listener import LostTransform, PoseListener
from rbx1_nav.ros.driving.rate import Rate, pause
from rbx1_nav.ros.driving.waiting import wait_for_subscribers
from rbx1_nav.ros.node import life
from rbx1_nav.ros.node.params import frame_param, positive_param
from rbx1_nav.units import wrap_angle


class OutAndBack:
    """Drives the robot once out and back; creating one runs it."""

    def __init__(self):
        # Start the node under this name. From here on Ctrl-C leads to stop() below.
        life.init_node('out_and_back', __doc__)

        # How often to look at the pose and to publish a command, in Hz.
        self.rate = positive_param('rate', 50, 2, 1000)

        # How far to go, and how fast. Near the goal the robot slows down, to the lowest speed that moves it.
        linear_speed = positive_param('linear_speed', 0.2)                  # m/s
        angular_speed = positive_param('angular_speed', 1.0)                # rad/s
        legs = out_and_back_by_odometry(
            linear_speed=linear_speed,
            goal_distance=positive_param('goal_distance', 1.0),             # m
            angular_speed=angular_speed,
            goal_angle=positive_param('goal_angle', pi),                    # rad
            rate=self.rate,
            min_linear_speed=positive_param('min_linear_speed', 0.05),      # m/s
            min_angular_speed=positive_param('min_angular_speed', 0.2))     # rad/s
        wait_timeout = positive_param('wait_timeout', 30)                   # s
        self.transform_timeout = positive_param('transform_timeout', 5)     # s

        # Where the robot is: the pose of its base in the frame of its odometry.
        self.poses = PoseListener(frame_param('odom_frame', 'odom'), frame_param('base_frame', None),
                                  linear_speed, angular_speed)

        # The robot's base subscribes to this topic. With a queue, a slow subscriber does not hold up the others.
        self.cmd_vel = rospy.Publisher('/cmd_vel', Twist, queue_size=5)

        try:
            # What is published before anyone subscribes is lost.
            self.listeners = wait_for_subscribers(self.cmd_vel, wait_timeout)
            start = self.poses.wait(wait_timeout)
            rospy.loginfo('Measuring the pose of %s in the frame %s', self.poses.base_frame, self.poses.odom_frame)

            for leg in legs:
                rospy.loginfo('%s: %.2f %s', leg.name, leg.goal, leg.unit)
                with tqdm(total=leg.goal, desc=leg.name, unit=leg.unit, disable=None,
                          bar_format='{desc:9}: |{bar}| {n:.2f} of {total:.2f} {unit}') as bar:
                    # A leg stops twice: just before its goal, to see how far the robot rolls on, and at its goal.
                    self.drive(leg, bar)
                    self.rest(0.5)
                    self.drive(leg, bar)
                self.rest(1)

            self.cmd_vel.publish(Twist())
        finally:
            # However it ended: the most important thing that a mobile robot must do.
            self.stop()

        # Say so if the base did not get every command.
        self.listeners.check_delivery()
        end = self.poses.wait(self.transform_timeout)
        rospy.loginfo('Done: measured in %s, the robot is %.3f m from its start and %.1f degrees off its first heading',
                      self.poses.odom_frame, hypot(end.x - start.x, end.y - start.y),
                      degrees(abs(wrap_angle(end.yaw - start.yaw))))

    def drive(self, leg, bar):
        """Look at the pose, and drive on until the leg is to stop. Shows its progress."""
        rate = Rate(self.rate, self.listeners)
        command = Twist()
        speed = leg.next_speed(self.pose())
        while speed:
            command.linear.x, command.angular.z = leg.velocity(speed)
            self.cmd_vel.publish(command)
            rate.sleep()
            speed = leg.next_speed(self.pose())
            bar.update(max(0, min(leg.done(), leg.goal) - bar.n))

    def rest(self, seconds):
        """Stop, and come to rest."""
        self.cmd_vel.publish(Twist())
        pause(seconds, self.listeners)
        self.poses.forget_velocity()

    def pose(self):
        """The robot's pose. If it is lost, the robot stands and waits for it."""
        try:
            return self.poses.pose()
        except LostTransform as error:
            self.cmd_vel.publish(Twist())
            rospy.logwarn('%s: the robot waits for a new one', error)
            return self.poses.wait(self.transform_timeout, self.listeners.check)

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
    except (rospy.ROSException, ValueError) as error:     # StuckError is a ValueError
        rospy.logerr('%s', error)
        status = 1
    life.leave(status)
