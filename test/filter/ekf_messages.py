#!/usr/bin/python3
"""What the filter node makes of bad messages, of sensors that fall silent, and of a new sender."""
import math
import threading
import unittest

import rospy
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus
from geometry_msgs.msg import PoseWithCovarianceStamped
from nav_msgs.msg import Odometry
from rosgraph_msgs.msg import Log
from sensor_msgs.msg import Imu
from std_msgs.msg import Empty

import support


def make_odom():
    """A standing robot's odometry, of now."""
    message = Odometry()
    message.header.stamp = rospy.Time.now()
    message.header.frame_id, message.child_frame_id = '/odom', '/base_footprint'    # as old senders write it
    message.pose.pose.position.x = 0.5
    message.pose.pose.orientation.w = 1.0
    message.pose.covariance[::7] = message.twist.covariance[::7] = [1e-6] * 6
    return message


def make_imu():
    """A standing robot's gyro, of now."""
    message = Imu()
    message.header.stamp = rospy.Time.now()
    message.angular_velocity_covariance[8] = 1e-6
    return message


class Sender(threading.Thread):
    """Sends a sensor's good messages at about 50 Hz, and others in between."""

    def __init__(self, topic, make):
        super().__init__(daemon=True)
        self.publisher = rospy.Publisher(topic, type(make()), queue_size=100)
        self.make = make
        self.lock = threading.Lock()
        self.speaking = True
        self.done = threading.Event()
        self.start()

    def run(self):
        while not self.done.wait(0.02):
            with self.lock:
                if self.speaking:
                    self.publisher.publish(self.make())

    def send(self, change):
        """One more message, with something changed in it."""
        with self.lock:
            message = self.make()
            change(message)
            self.publisher.publish(message)

    def end(self):
        """Be gone."""
        self.done.set()
        self.join()
        self.publisher.unregister()


class TestEkfMessages(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        support.init_node('ekf_messages')
        cls.log = support.Watch('/rosout', Log)
        cls.poses = support.Watch('odom_combined', PoseWithCovarianceStamped)
        cls.diagnostics = support.Watch('/diagnostics', DiagnosticArray)
        cls.odom, cls.imu = Sender('odom', make_odom), Sender('imu_data', make_imu)
        support.wait_for(lambda: cls.poses.last, 'a combined pose')

    def said(self, *texts):
        """Wait for a line of the filter with all these in it."""
        support.wait_for(lambda: any(m.name == '/robot_pose_ekf' and all(text in m.msg for text in texts)
                                     for m in list(self.log.messages)), 'the filter to say %s' % (texts,))

    def status(self, sensor, level):
        """Wait for the diagnostics to say so of a sensor."""
        support.wait_for(lambda: self.diagnostics.messages and any(
            status.name.endswith(sensor) and status.level == level
            for m in self.diagnostics.messages[-3:] for status in m.status), '%s in /diagnostics: %s' % (sensor, level))

    def test_bad_messages_are_refused_by_name(self):
        nan = float('nan')
        before = self.poses.next().pose.pose.position.x
        for sender, change, words in [
                (self.odom, lambda m: setattr(m.pose.pose.position, 'x', nan), ('/odom: pose.pose.position.x: nan',)),
                (self.odom, lambda m: setattr(m.pose.pose.orientation, 'w', 0.0), ('/odom: pose.pose.orientation',)),
                (self.odom, lambda m: setattr(m.pose, 'covariance', [0.0] * 36), ('/odom: pose.covariance[0]: 0.0',)),
                (self.odom, lambda m: setattr(m.header, 'stamp', m.header.stamp - rospy.Duration(5)),
                 ('/odom: header.stamp', 'later than the last')),
                (self.odom, lambda m: setattr(m.header, 'stamp', m.header.stamp + rospy.Duration(5)),
                 ('/odom: header.stamp', 'none later than now')),
                (self.imu, lambda m: setattr(m.angular_velocity, 'z', nan), ('/imu_data: angular_velocity.z: nan',)),
                (self.imu, lambda m: setattr(m, 'angular_velocity_covariance', [0.0] * 9),
                 ('/imu_data: angular_velocity_covariance[8]: 0.0',)),
                (self.imu, lambda m: setattr(m.header, 'stamp', m.header.stamp + rospy.Duration(3600)),
                 ('/imu_data: header.stamp', 'none later than now'))]:
            sender.send(change)
            self.said(*words, 'expected', 'refused')
        pose = self.poses.next().pose
        self.assertAlmostEqual(pose.pose.position.x, before, delta=1e-6)
        self.assertTrue(all(math.isfinite(value) for value in pose.covariance))

    def test_frames_without_a_name_are_refused(self):
        self.odom.send(lambda m: setattr(m, 'child_frame_id', ''))
        self.said("/odom: child_frame_id: ''", 'expected', 'refused')
        self.poses.next()

    def test_reset_odometry_is_a_new_beginning(self):
        reset = rospy.Publisher('reset_odometry', Empty, queue_size=1)
        support.wait_for(reset.get_num_connections, 'the filter to listen')
        reset.publish()
        self.said('reset_odometry', 'starting again')
        self.poses.next()

    def test_a_gyro_that_contradicts_the_wheels_is_diagnosed(self):
        turning = [0]

        def make():
            message = make_odom()
            turning[0] += 1
            message.pose.pose.orientation.z = math.sin(turning[0] * 0.01)
            message.pose.pose.orientation.w = math.cos(turning[0] * 0.01)
            return message
        standing, self.odom.make = self.odom.make, make
        support.wait_for(lambda: any('contradict' in status.message for m in self.diagnostics.messages[-3:]
                                     for status in m.status), 'a contradiction in /diagnostics')
        self.odom.make = standing
        self.status('odom', DiagnosticStatus.OK)

    def test_a_silent_gyro_is_left_out_and_taken_back(self):
        self.status('imu_data', DiagnosticStatus.OK)
        self.imu.speaking = False
        self.said('imu_data: no message', 'left out')
        self.status('imu_data', DiagnosticStatus.WARN)
        self.poses.next()
        self.imu.speaking = True
        self.said('imu_data is back')
        self.status('imu_data', DiagnosticStatus.OK)
        self.poses.next()

    def test_silent_odometry_is_left_out_and_taken_back(self):
        before = self.poses.next().pose.covariance[0]
        self.odom.speaking = False
        self.said('odom: no message', 'left out')
        self.status('odom', DiagnosticStatus.WARN)
        # nobody tells where the robot goes meanwhile
        support.wait_for(lambda: self.poses.last.pose.covariance[0] > 0.2, 'a growing uncertainty')
        self.odom.speaking = True
        self.said('odom is back')
        support.wait_for(lambda: self.poses.last.pose.covariance[0] < 2 * before + 1e-6, 'the old uncertainty')
        self.status('odom', DiagnosticStatus.OK)

    def test_a_new_sender_is_a_new_beginning(self):
        self.odom.end()

        def make():
            message = make_odom()
            message.pose.pose.position.x = 0.48     # near enough to be the same robot
            return message
        type(self).odom = Sender('odom', make)
        self.said('another sender')
        support.wait_for(lambda: abs(self.poses.last.pose.pose.position.x - 0.48) < 1e-9, 'the new place')


if __name__ == '__main__':
    support.main('ekf_messages', TestEkfMessages)
