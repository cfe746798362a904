#!/usr/bin/python3
"""The filter node rejects invalid messages, handles timeouts and recovery of sensors, and restarts after resets."""
from functools import partial
import itertools
import math

import rospy
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus
from geometry_msgs.msg import PoseWithCovarianceStamped
from rosgraph_msgs.msg import Log
from std_msgs.msg import Empty

from still_robot import Sender, make_imu, make_odom
import support


class TestEkfMessages(support.Case):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.log = support.Watch('/rosout', Log)
        cls.poses = support.Watch('robot_pose_ekf/odom_combined', PoseWithCovarianceStamped)
        cls.diagnostics = support.Watch('/diagnostics', DiagnosticArray)
        cls.odom, cls.imu = Sender('odom', make_odom), Sender('imu_data', make_imu)
        support.wait_for(lambda: cls.poses.last, 'a combined pose')

    def wait_for_log(self, *texts, send=lambda: None):
        """Wait until the filter has logged a line with all these texts. send(): called until then, because the filter
        does not log all lines."""
        def is_logged():
            send()
            return any(m.name == '/robot_pose_ekf' and all(text in m.msg for text in texts)
                       for m in list(self.log.messages))
        support.wait_for(is_logged, f'a line of the filter with {texts}')

    def wait_for_status(self, sensor, level):
        """Wait until /diagnostics has this level for a sensor."""
        support.wait_for(lambda: self.diagnostics.messages and any(
            status.name.endswith(sensor) and status.level == level
            for m in self.diagnostics.messages[-3:] for status in m.status), f'{sensor} in /diagnostics: {level}')

    def test_invalid_messages_are_rejected_by_the_name_of_the_field(self):
        nan = float('nan')
        before = self.poses.next().pose.pose.position.x
        for sender, change, words in [
                (self.odom, lambda m: setattr(m.pose.pose.position, 'x', nan), ('/odom: pose.pose.position.x: nan',)),
                (self.odom, lambda m: setattr(m.header, 'stamp', m.header.stamp - rospy.Duration(5)),
                 ('/odom: header.stamp', 'later than the last')),
                (self.imu, lambda m: setattr(m.angular_velocity, 'z', nan), ('/imu_data: angular_velocity.z: nan',)),
                (self.imu, lambda m: setattr(m.header, 'stamp', m.header.stamp + rospy.Duration(3600)),
                 ('/imu_data: header.stamp', 'not later than now'))]:
            self.wait_for_log(*words, 'expected', 'rejected', send=partial(sender.send, change))
        pose = self.poses.next().pose
        self.assertAlmostEqual(pose.pose.position.x, before, delta=1e-6)
        self.assertTrue(all(math.isfinite(value) for value in pose.covariance))

    def test_reset_odometry_restarts_the_filter(self):
        reset = rospy.Publisher('reset_odometry', Empty, queue_size=1)
        support.wait_for(reset.get_num_connections, 'the filter to subscribe to reset_odometry')
        self.wait_for_log('Odometry was reset: restarting', send=reset.publish)
        self.poses.next()

    def check_diagnosed(self, text, make):
        """Check that /diagnostics has a message while the odometry is made by make()."""
        standing, self.odom.make = self.odom.make, make
        support.wait_for(lambda: any(status.message == text for m in self.diagnostics.messages[-3:]
                                     for status in m.status), f'{text} in /diagnostics')
        self.odom.make = standing
        self.wait_for_status('odom', DiagnosticStatus.OK)

    def test_wheels_and_gyro_that_contradict_each_other_are_diagnosed(self):
        angles = itertools.count(0.01, 0.01)

        def make():
            message, angle = make_odom(), next(angles)
            message.pose.pose.orientation.z, message.pose.pose.orientation.w = math.sin(angle), math.cos(angle)
            return message
        self.check_diagnosed('Wheels and gyro contradict each other', make)

    def test_jumps_that_do_not_agree_with_each_other_are_diagnosed(self):
        places = itertools.cycle([5.0, -5.0])

        def make():
            message = make_odom()
            message.pose.pose.position.x = next(places)
            return message
        self.check_diagnosed('Odometry ignored: faster than ~max_speed or ~max_turn_rate', make)

    def test_set_pose(self):
        publisher = rospy.Publisher('/set_pose', PoseWithCovarianceStamped, queue_size=10)
        support.wait_for(publisher.get_num_connections, 'the filter to subscribe to /set_pose')
        pose = PoseWithCovarianceStamped()
        pose.pose.pose.orientation.w = 1.0
        pose.pose.covariance[0] = pose.pose.covariance[7] = pose.pose.covariance[35] = 0.25
        for pose.header.frame_id, x in ('odom_combined', 3.0), ('', 0.5):
            pose.pose.pose.position.x = x
            publisher.publish(pose)
            support.wait_for(lambda: abs(self.poses.next().pose.pose.position.x - x) < 1e-6, f'the pose at x = {x} m')
            self.assertAlmostEqual(self.poses.last.pose.covariance[0], 0.25, delta=0.01)
        pose.header.frame_id = 'map'
        self.wait_for_log("/set_pose: header.frame_id: 'map': expected odom_combined, the output_frame; rejected",
                          send=partial(publisher.publish, pose))

    def test_a_sensor_times_out_and_recovers(self):
        for sensor, name in (self.imu, 'imu_data'), (self.odom, 'odom'):
            self.wait_for_status(name, DiagnosticStatus.OK)
            self.poses.next()
            sensor.active = False
            self.wait_for_log(f'{name} has timed out')
            self.wait_for_status(name, DiagnosticStatus.WARN)
            if sensor is self.imu:      # the odometry alone measures the position
                self.poses.next()
            count = len(self.poses.messages)
            sensor.active = True
            self.wait_for_log(f'{name} has recovered')
            self.wait_for_status(name, DiagnosticStatus.OK)
            support.wait_for(lambda: len(self.poses.messages) > count, 'another pose')

    def test_another_sender_at_the_same_time_is_ignored(self):
        support.Process('rostopic', 'pub', '-r', '20', '/odom', 'nav_msgs/Odometry', '{}')
        support.Process('rostopic', 'pub', '-r', '20', '/imu_data', 'sensor_msgs/Imu', '{}')
        for topic in '/odom', '/imu_data':
            self.wait_for_log(f'{topic}: messages from /rostopic', 'ignored', 'also publishes this topic')
        self.assertAlmostEqual(self.poses.next().pose.pose.position.x, 0.5, delta=0.01)

    def test_another_sender_restarts_the_filter(self):
        self.odom.end()
        other = support.Process(
            'rostopic', 'pub', '-s', '-r', '50', '/odom', 'nav_msgs/Odometry',
            '{header: {stamp: now, frame_id: odom}, child_frame_id: base_footprint, '
            'pose: {pose: {position: {x: 0.48}, orientation: {w: 1.0}}}}')     # too close for a jump
        self.wait_for_log('odom comes from another node: restarting')
        support.wait_for(lambda: abs(self.poses.last.pose.pose.position.x - 0.48) < 1e-9, 'the new pose')
        other.kill()
        type(self).odom = Sender('odom', make_odom)
        support.wait_for(lambda: abs(self.poses.last.pose.pose.position.x - 0.5) < 1e-9, 'the old pose')


if __name__ == '__main__':
    support.main(TestEkfMessages)
