#!/usr/bin/env python3
"""Drives out and back using odometry: forward 1 m, turn left 180 degrees, forward 1 m, turn left 180 degrees.

usage: odom_out_and_back.py [_parameter:=value ...] [topic:=new_topic ...]
example: rosrun rbx1_nav odom_out_and_back.py _odom_frame:=odom_combined

The base measures how far its wheels turn, and publishes its pose: the transform from the frame odom to its own frame.
So the script does not drive for a fixed time. It drives until the pose shows that the robot has arrived.
"""
from rbx1_nav.ros.driving.script import exit_status, frame, init_node, number, param

from math import pi
import time

import rospy
from geometry_msgs.msg import Twist

from rbx1_nav.control.legs import Straight, Turn
from rbx1_nav.ros.driving.pose_drive import OdomDrive
from rbx1_nav.ros.driving.pose_listener import PoseListener

# What can be set on the command line: name, default, unit, meaning. --help prints this list.
PARAMETERS = [
    number('rate', 50, 'Hz', 'commands per second', 2, 1000),
    number('linear_speed', 0.2, 'm/s', 'forward speed'),
    number('goal_distance', 1.0, 'm', 'length of each leg'),
    number('min_linear_speed', 0.05, 'm/s', 'lowest speed near the goal; a lower one may not move your robot'),
    number('angular_speed', 1.0, 'rad/s', 'turning speed'),
    number('goal_angle', pi, 'rad', 'angle of each turn to the left', shown='pi'),
    number('min_angular_speed', 0.2, 'rad/s', 'lowest turning speed near the goal'),
    frame('odom_frame', 'odom', 'frame in which the pose is measured; odom_combined: from wheels and gyro'),
    frame('base_frame', None, 'frame of the robot', shown='base_footprint or base_link, whichever exists'),
    number('transform_timeout', 5, 's', 'maximum wait of the stopped robot for a missing pose', note='wall time')]


class OutAndBack:
    """Drives the robot once out and back; creating one runs it."""

    def __init__(self):
        # Start the node under this name.
        init_node('out_and_back', __doc__, PARAMETERS)

        # The base subscribes to this topic. With a queue, a slow subscriber does not hold up the others.
        self.cmd_vel = rospy.Publisher('cmd_vel', Twist, queue_size=5)

        # Check the pose and publish a command at this rate (Hz).
        rate = param('rate')

        # Forward: speed (m/s), distance (m), and the lowest speed, because the robot slows down near its goal.
        linear_speed = param('linear_speed')
        goal_distance = param('goal_distance')
        min_linear_speed = param('min_linear_speed')

        # Turn left: speed (rad/s), angle (rad), and the lowest speed.
        angular_speed = param('angular_speed')
        goal_angle = param('goal_angle')
        min_angular_speed = param('min_angular_speed')

        # Two legs: out and back. Each motion calculates the distance to its goal, and the speed to get there. Shortly
        # before the goal, the loops below stop once, to measure how far the robot coasts.
        legs = [(Straight('forward', goal_distance, linear_speed, min_linear_speed, rate),
                 Turn('turn left', goal_angle, angular_speed, min_angular_speed, rate)) for _ in range(2)]

        # Where the robot is: the pose of its base in the frame of its odometry.
        transform_timeout = param('transform_timeout')
        poses = PoseListener(param('odom_frame'), param('base_frame'), linear_speed, angular_speed)

        # Wait for the base, and monitor it from here on. However this block exits, it calls shutdown().
        with OdomDrive(self.cmd_vel, rate, self.shutdown, poses, transform_timeout) as drive:
            for forward, turn_left in legs:
                # Drive forward: on every tick, look at the pose, publish the command, then sleep until the next tick.
                move_cmd = Twist()
                r = drive.Rate()
                for speed in drive.speeds(forward):
                    move_cmd.linear.x = speed
                    self.cmd_vel.publish(move_cmd)
                    r.sleep()
                # Stop the robot, and let it come to rest before the turn.
                self.cmd_vel.publish(Twist())
                drive.rest(1)
                # Turn left, again until the robot has arrived.
                move_cmd = Twist()
                r = drive.Rate()
                for speed in drive.speeds(turn_left):
                    move_cmd.angular.z = speed
                    self.cmd_vel.publish(move_cmd)
                    r.sleep()
                # Stop and rest again before the next leg.
                self.cmd_vel.publish(Twist())
                drive.rest(1)
            # Stop the robot for good.
            self.cmd_vel.publish(Twist())

    def shutdown(self):
        """Stop the robot: the most important thing to do, whatever the reason for the shutdown."""
        self.cmd_vel.publish(Twist())
        rospy.loginfo('Stopping the robot...')
        time.sleep(1)   # wall time, since a simulated clock may have stopped


if __name__ == '__main__':
    with exit_status():
        try:
            OutAndBack()
        except rospy.ROSInterruptException:
            rospy.loginfo('Out-and-Back node terminated.')
