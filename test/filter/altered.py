"""A robot whose sensors reach the filter as other drivers would send them."""
import math

import rospy
from geometry_msgs.msg import PoseWithCovarianceStamped
from nav_msgs.msg import Odometry
from rosgraph_msgs.msg import Log
from sensor_msgs.msg import Imu

import support

STANDSTILL = 100    # messages of the odometry, 2 s: time for the filter to estimate the bias of the gyro
TURNS = 4           # of about 50 degrees: in the end the wheels are off by more than
WHEEL_ERROR = math.radians(30)
GYRO_ERROR = math.radians(3)    # what is left of bias, scale error and noise is about a degree


class AlteredRobot:
    """Sends the odometry and the IMU of the simulated base on to the filter, altered."""

    def __init__(self, odom=lambda message: None, imu=lambda message: None):
        """odom(message), imu(message): alter a message."""
        self.log = support.Watch('/rosout', Log)
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
        """The lines of the filter with a text."""
        return [m.msg for m in list(self.log.messages) if m.name == '/robot_pose_ekf' and text in m.msg]

    def wait_for_line(self, text):
        """Wait until the filter has logged a line with a text."""
        support.wait_for(lambda: self.lines(text), f'a line of the filter with {text!r}')

    def turn(self):
        """Stand, turn left, and stand again."""
        count = len(self.odom.messages)
        support.wait_for(lambda: len(self.odom.messages) > count + STANDSTILL, 'the odometry of a standstill')
        for _ in range(TURNS):
            self.commander.send(0.1, 1.0)
            support.wait_for(lambda: self.odom.last.twist.twist.angular.z > 0.5, 'the robot to turn')
            self.odom.wait_for_twist(0.0)
        self.estimates.next()
        self.estimates.next()

    def check_heading(self, case):
        """The estimate has followed the gyro: it is right although the wheels are not."""
        true = support.yaw(self.truth.last)
        case.assertGreater(abs(support.wrapped(support.yaw(self.odom.last) - true)), WHEEL_ERROR)
        case.assertLess(abs(support.wrapped(support.yaw(self.estimates.last) - true)), GYRO_ERROR)
