"""A robot whose sensor messages are altered to look like messages from other drivers."""
import math

import rospy
from geometry_msgs.msg import PoseWithCovarianceStamped
from nav_msgs.msg import Odometry
from rosgraph_msgs.msg import Log
from sensor_msgs.msg import Imu

import support

STANDSTILL = 100    # odometry messages in 2 s: time for the filter to estimate the gyro bias
TURNS = 4           # turns of about 50 degrees, after which the wheels are off by more than
WHEEL_ERROR = math.radians(30)
GYRO_ERROR = math.radians(3)    # the remaining bias, scale error and noise amount to about a degree


class AlteredRobot:
    """Passes altered odometry and IMU messages of the simulated base on to the filter."""

    def __init__(self, odom=lambda message: None, imu=lambda message: None):
        """odom(message), imu(message): alter a message."""
        self.log = support.Watch('/rosout', Log)
        self.log.wait_for_publisher('/robot_pose_ekf')
        self.truth = support.Watch('/ground_truth', Odometry)
        self.odom = support.OdomWatch()
        self.estimates = support.Watch('/robot_pose_ekf/odom_combined', PoseWithCovarianceStamped)
        self.commander = support.Commander()
        for topic, target, kind, alter in [('/odom', '/odom_altered', Odometry, odom),
                                           ('/imu/data', '/imu_altered', Imu, imu)]:
            publisher = rospy.Publisher(target, kind, queue_size=10000, tcp_nodelay=True)
            support.wait_for(publisher.get_num_connections, f'the filter to subscribe to {target}')
            rospy.Subscriber(topic, kind, self._pass_on, (publisher, alter), tcp_nodelay=True)

    def _pass_on(self, message, where):
        publisher, alter = where
        alter(message)
        publisher.publish(message)

    def lines(self, text):
        """Return the lines that the filter has logged with a text."""
        return [m.msg for m in list(self.log.messages) if m.name == '/robot_pose_ekf' and text in m.msg]

    def wait_for_line(self, text):
        """Wait until the filter has logged a line with a text."""
        support.wait_for(lambda: self.lines(text), f'a line of the filter with {text!r}')

    def turn(self):
        """Stay stationary, turn left, and stay stationary again."""
        count = len(self.odom.messages)
        support.wait_for(lambda: len(self.odom.messages) > count + STANDSTILL, 'the odometry of a standstill')
        for _ in range(TURNS):
            self.commander.send(0.1, 1.0)
            support.wait_for(lambda: self.odom.last.twist.twist.angular.z > 0.5, 'the robot to turn')
            self.odom.wait_for_twist(0.0)
        self.estimates.next()
        self.estimates.next()

    def check_heading(self, case):
        """Check that the estimate has followed the gyro and is right although the wheels are wrong."""
        true = support.yaw(self.truth.last)
        case.assertGreater(abs(support.wrapped(support.yaw(self.odom.last) - true)), WHEEL_ERROR)
        case.assertLess(abs(support.wrapped(support.yaw(self.estimates.last) - true)), GYRO_ERROR)
