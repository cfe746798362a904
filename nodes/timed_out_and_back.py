#!/usr/bin/env python3
"""Drives out and back, timed: forward 1 m, turn left 180 degrees, forward 1 m, turn left 180 degrees.

usage: timed_out_and_back.py [_parameter:=value ...] [topic:=new_topic ...]
example: rosrun rbx1_nav timed_out_and_back.py _goal_distance:=0.5

The script never asks where the robot is. After known times at known speeds, the robot should be back at its start.

Parameters:
    ~rate            commands per second (Hz; 2 to 1000; default: 50)
    ~linear_speed    forward speed (m/s; default: 0.2)
    ~goal_distance   length of each leg (m; default: 1)
    ~angular_speed   turning speed (rad/s; default: 1)
    ~goal_angle      angle of each turn to the left (rad; default: pi)
"""
from rbx1_nav.driving import Drive

from math import pi

import rospy
from geometry_msgs.msg import Twist


class OutAndBack:
    """Creating an object of this class drives the robot out and back once."""

    def __init__(self):
        # Start the node under this name.
        rospy.init_node('out_and_back', anonymous=False)

        # Call this function when the node shuts down, so that the robot does not keep moving.
        rospy.on_shutdown(self.shutdown)

        # The base subscribes to this topic. With a queue, a slow subscriber does not hold up the others.
        self.cmd_vel = rospy.Publisher('cmd_vel', Twist, queue_size=5)

        # Publish commands at this rate (Hz). Many robots stop unless they receive a steady stream of commands.
        rate = rospy.get_param('~rate', 50)

        # Forward: speed (m/s) and distance (m) give the duration (s).
        linear_speed = rospy.get_param('~linear_speed', 0.2)
        goal_distance = rospy.get_param('~goal_distance', 1.0)
        linear_duration = goal_distance / linear_speed

        # Turn left: the same calculation, in rad/s and rad.
        angular_speed = rospy.get_param('~angular_speed', 1.0)
        goal_angle = rospy.get_param('~goal_angle', pi)
        angular_duration = goal_angle / angular_speed

        # Each motion needs at least one tick, which is one period of the rate: otherwise it would send no command.
        if min(linear_duration, angular_duration) * rate + 1e-9 < 1:
            raise rospy.ROSException(f'goal_distance {goal_distance}, goal_angle {goal_angle}: expected a tick or more')

        # Wait for the base, and monitor it from here on. However this block is left, the robot is stopped.
        with Drive(self.cmd_vel):
            # Two legs: out and back.
            for leg in range(2):
                # Drive forward: on every tick, publish the command, then sleep until the next tick.
                move_cmd = Twist()
                move_cmd.linear.x = linear_speed
                r = rospy.Rate(rate)    # a new one for each motion: an old one would skip its first sleep
                ticks = int(linear_duration * rate + 1e-9)     # int() rounds down; 0.3 / 0.1 is slightly below 3
                for tick in range(ticks):
                    self.cmd_vel.publish(move_cmd)
                    r.sleep()
                # Stop the robot, and let it come to rest before the turn.
                self.cmd_vel.publish(Twist())
                rospy.sleep(1)
                # Turn left in the same way.
                move_cmd = Twist()
                move_cmd.angular.z = angular_speed
                r = rospy.Rate(rate)
                ticks = int(angular_duration * rate + 1e-9)
                for tick in range(ticks):
                    self.cmd_vel.publish(move_cmd)
                    r.sleep()
                # Stop and rest again before the next leg.
                self.cmd_vel.publish(Twist())
                rospy.sleep(1)
            # Stop the robot for good.
            self.cmd_vel.publish(Twist())

    def shutdown(self):
        """Stop the robot: the most important thing to do, whatever the reason for the shutdown."""
        rospy.loginfo('Stopping the robot...')
        self.cmd_vel.publish(Twist())
        rospy.sleep(1)


if __name__ == '__main__':
    try:
        OutAndBack()
    except rospy.ROSInterruptException:
        rospy.loginfo('Out-and-Back node terminated.')
