#!/usr/bin/env python3
"""Drives out and back using odometry: forward 1 m, turn left 180 degrees, forward 1 m, turn left 180 degrees.

usage: odom_out_and_back.py [_parameter:=value ...] [topic:=new_topic ...]
example: rosrun rbx1_nav odom_out_and_back.py _odom_frame:=odom_combined

The base measures how far its wheels turn, and publishes its pose: the transform from the frame odom to its own frame.
So the script does not drive for a fixed time. It drives until the pose shows that the robot has arrived.

Parameters:
    ~rate                commands per second (Hz; 2 to 1000; default: 50)
    ~linear_speed        forward speed (m/s; default: 0.2)
    ~goal_distance       length of each leg (m; default: 1)
    ~min_linear_speed    lowest speed near the goal; a lower one may not move your robot (m/s; default: 0.05)
    ~angular_speed       turning speed (rad/s; default: 1)
    ~goal_angle          angle of each turn to the left (rad; default: pi)
    ~min_angular_speed   lowest turning speed near the goal (rad/s; default: 0.2)
    ~odom_frame          frame in which the pose is measured; odom_combined: from wheels and gyro (default: odom)
    ~base_frame          frame of the robot (default: base_footprint or base_link, whichever exists)
    ~transform_timeout   maximum wait of the stopped robot for a missing pose, wall time (s; default: 5)
"""
from rbx1_nav.driving import Drive

from math import degrees, hypot, pi, remainder

import rospy
from geometry_msgs.msg import Twist

from rbx1_nav.driving.odometry import PoseListener, Straight, Turn


class OutAndBack:
    """Creating an object of this class drives the robot out and back once."""

    def __init__(self):
        # Start the node under this name.
        rospy.init_node('out_and_back', anonymous=False)

        # Call this function when the node shuts down, so that the robot does not keep moving.
        rospy.on_shutdown(self.shutdown)

        # The base subscribes to this topic. With a queue, a slow subscriber does not hold up the others.
        self.cmd_vel = rospy.Publisher('cmd_vel', Twist, queue_size=5)

        # Look at the pose and publish a command at this rate (Hz).
        self.rate = rospy.get_param('~rate', 50)

        # Forward: speed (m/s), distance (m), and the lowest speed, because the robot slows down near its goal.
        linear_speed = rospy.get_param('~linear_speed', 0.2)
        goal_distance = rospy.get_param('~goal_distance', 1.0)
        min_linear_speed = rospy.get_param('~min_linear_speed', 0.05)

        # Turn left: speed (rad/s), angle (rad), and the lowest speed.
        angular_speed = rospy.get_param('~angular_speed', 1.0)
        goal_angle = rospy.get_param('~goal_angle', pi)
        min_angular_speed = rospy.get_param('~min_angular_speed', 0.2)

        # Out and back: four motions. Each calculates the distance to its goal, and the speed to get there.
        motions = [(Straight('forward', goal_distance, linear_speed, min_linear_speed, self.rate),
                    Turn('turn left', goal_angle, angular_speed, min_angular_speed, self.rate)) for _ in range(2)]

        # Where the robot is: the transform from the frame of its odometry to its base, looked up with tf2. A pose that
        # the robot cannot have reached at these speeds is an error.
        self.odom = PoseListener(rospy.get_param('~odom_frame', 'odom'), rospy.get_param('~base_frame', None),
                                 linear_speed, angular_speed, rospy.get_param('~transform_timeout', 5))

        # Wait for the base, and monitor it from here on. However this block is left, the robot is stopped. A late
        # command is no error (timed=False), because the script looks at the pose.
        with Drive(self.cmd_vel, timed=False):
            start = self.odom.pose()
            for forward, turn_left in motions:
                self.drive(forward)
                self.drive(turn_left)
            # Stop the robot for good.
            self.cmd_vel.publish(Twist())
            end = self.odom.pose()
            rospy.loginfo('Measured in %s, the robot is %.3f m from its start and %.1f degrees off its initial heading',
                          self.odom.odom_frame, hypot(end.x - start.x, end.y - start.y),
                          degrees(abs(remainder(end.yaw - start.yaw, 2 * pi))))

    def drive(self, leg):
        """Drive a leg or a turn until its goal is reached."""
        # In two parts: to a stop just before the goal, which shows how far the robot coasts, and then to the goal.
        for rest in leg.rests:
            move_cmd = Twist()
            r = rospy.Rate(self.rate)
            # On every tick, look at the pose, publish the command, then sleep until the next tick.
            speed = leg.next_speed(self.odom.pose())
            while speed:    # 0 at the goal
                move_cmd.linear.x, move_cmd.angular.z = leg.velocity(speed)
                self.cmd_vel.publish(move_cmd)
                r.sleep()
                speed = leg.next_speed(self.odom.pose())
            # Stop the robot, and let it come to rest.
            self.cmd_vel.publish(Twist())
            rospy.sleep(rest)

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
