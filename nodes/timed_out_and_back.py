#!/usr/bin/env python3
"""Drives out and back, timed: forward 1 m, turn left 180 degrees, forward 1 m, turn left 180 degrees.

usage: timed_out_and_back.py [_parameter:=value ...] [topic:=new_topic ...]
example: rosrun rbx1_nav timed_out_and_back.py _goal_distance:=0.5

The script never asks where the robot is. After known times at known speeds, the robot should be back at its start.
"""
from rbx1_nav.ros.driving.script import TimedDrive, exit_status, init_node, number, param, whole_ticks

from math import pi
import time

import rospy
from geometry_msgs.msg import Twist

# What can be set on the command line: name, default, unit, meaning. --help prints this list.
PARAMETERS = [
    number('rate', 50, 'Hz', 'commands per second', 2, 1000),
    number('linear_speed', 0.2, 'm/s', 'forward speed'),
    number('goal_distance', 1.0, 'm', 'length of each leg'),
    number('angular_speed', 1.0, 'rad/s', 'turning speed'),
    number('goal_angle', pi, 'rad', 'angle of each turn to the left', shown='pi')]


class OutAndBack:
    """Drives the robot once out and back; creating one runs it."""

    def __init__(self):
        # Start the node under this name.
        init_node('out_and_back', __doc__, PARAMETERS)

        # The base subscribes to this topic. With a queue, a slow subscriber does not hold up the others.
        self.cmd_vel = rospy.Publisher('cmd_vel', Twist, queue_size=5)

        # Publish commands at this rate (Hz). Many robots stop unless they receive a steady stream of commands.
        rate = param('rate')

        # Forward: speed (m/s) and distance (m) give the duration (s), and with the rate the ticks, rounded down.
        linear_speed = param('linear_speed')
        goal_distance = param('goal_distance')
        linear_duration = goal_distance / linear_speed
        linear_ticks = whole_ticks(linear_duration * rate, 'goal_distance / linear_speed * rate')

        # Turn left: the same calculation, in rad/s and rad.
        angular_speed = param('angular_speed')
        goal_angle = param('goal_angle')
        angular_duration = goal_angle / angular_speed
        angular_ticks = whole_ticks(angular_duration * rate, 'goal_angle / angular_speed * rate')

        # Wait for the base, and monitor it from here on. However this block exits, it calls shutdown().
        with TimedDrive(self.cmd_vel, rate, self.shutdown) as drive:
            # Two legs: out and back.
            for _ in range(2):
                # Drive forward: on every tick, publish the command, then sleep until the next tick.
                move_cmd = Twist()
                move_cmd.linear.x = linear_speed
                r = drive.Rate()
                for _ in drive.progress('forward', linear_ticks, move_cmd):
                    self.cmd_vel.publish(move_cmd)
                    r.sleep()
                # Stop the robot, and let it come to rest before the turn.
                self.cmd_vel.publish(Twist())
                drive.rest(1)
                # Turn left in the same way.
                move_cmd = Twist()
                move_cmd.angular.z = angular_speed
                r = drive.Rate()
                for _ in drive.progress('turn left', angular_ticks, move_cmd):
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
