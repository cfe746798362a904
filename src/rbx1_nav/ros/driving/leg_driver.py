"""Drives legs by odometry, as odom_out_and_back.py does, for the scripts that calibrate the odometry."""
import time

import rospy
from geometry_msgs.msg import Twist
from tqdm import tqdm

from rbx1_nav.ros.driving.pose_listener import LostTransform, PoseListener
from rbx1_nav.ros.driving.rate import Rate, pause
from rbx1_nav.ros.driving.waiting import wait_for_subscribers


class LegDriver:
    """Publishes commands on /cmd_vel, and looks at the pose by tf2. stop() belongs into a `finally`."""

    def __init__(self, odom_frame, base_frame, linear_speed, angular_speed, rate):
        """As PoseListener; rate: of the commands, Hz."""
        self.rate = rate
        self.poses = PoseListener(odom_frame, base_frame, linear_speed, angular_speed)
        self.cmd_vel = rospy.Publisher('/cmd_vel', Twist, queue_size=5)
        self.listeners = None

    def wait_for_base(self, timeout):
        """Wait for a base that subscribes to /cmd_vel, and for its pose, each for at most `timeout` s.

        Raises ROSException, ROSInterruptException.
        """
        self.listeners = wait_for_subscribers(self.cmd_vel, timeout)
        self.poses.wait(timeout)

    def drive(self, leg):
        """Drive a leg to its end, and come to rest there: leg.done() and leg.last are then where the robot stands.

        Raises ROSException, ROSInterruptException, StuckError.
        """
        rospy.loginfo('%s: %.2f %s', leg.name, leg.goal, leg.unit)
        with tqdm(total=leg.goal, desc=leg.name, unit=leg.unit, disable=None,
                  bar_format='{desc:9}: |{bar}| {n:.2f} of {total:.2f} {unit}') as bar:
            # a leg stops twice: just before its goal, to see how far the robot rolls on, and at its goal
            self._drive(leg, bar)
            self.rest(0.5)
            self._drive(leg, bar)
        self.rest(1)
        leg.next_speed(self._pose())

    def rest(self, seconds):
        """Stop, and come to rest."""
        self.cmd_vel.publish(Twist())
        pause(seconds, self.listeners)
        self.poses.forget_velocity()

    def stop(self):
        """Stop the robot, and give it the time to do so."""
        self.cmd_vel.publish(Twist())
        rospy.loginfo('Stopping the robot...')
        time.sleep(1)   # wall time: a simulated clock may have stopped

    def _drive(self, leg, bar):
        rate = Rate(self.rate, self.listeners)
        command = Twist()
        speed = leg.next_speed(self._pose())
        while speed:
            command.linear.x, command.angular.z = leg.velocity(speed)
            self.cmd_vel.publish(command)
            rate.sleep()
            speed = leg.next_speed(self._pose())
            bar.update(max(0, min(leg.done(), leg.goal) - bar.n))

    def _pose(self):
        """The robot's pose. Raises ROSException if it is lost."""
        try:
            return self.poses.pose()
        except LostTransform as error:
            raise rospy.ROSException('The base no longer reports odometry (%s): expected a base that is connected to '
                                     'its robot; see /diagnostics' % error)
