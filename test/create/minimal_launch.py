#!/usr/bin/python3
"""turtlebot_minimal_create.launch starts everything that steps 5 to 7 of the tutorial need, on any serial port."""
import rospy
import tf2_ros
from sensor_msgs.msg import Imu, JointState

import support


class TestMinimalLaunch(support.Case):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.odom = support.OdomWatch()

    def test_frames(self):
        message = self.odom.last
        self.assertEqual((message.header.frame_id, message.child_frame_id), ('odom', 'base_footprint'))
        buffer = tf2_ros.Buffer()
        self.listener = tf2_ros.TransformListener(buffer)
        # the base publishes the first transform, and robot_state_publisher the others (the wheel's from joint_states)
        for frame in 'base_footprint', 'gyro_link', 'base_l_wheel_link':
            support.wait_for(lambda frame=frame: buffer.can_transform('odom', frame, rospy.Time(0)), frame)

    def test_sensors(self):
        for topic, kind in [('/imu/data', Imu), ('/joint_states', JointState)]:
            self.assertTrue(support.Watch(topic, kind).next())

    def test_the_robot_in_rviz_is_solid(self):
        # the robot is transparent only if there is a /ground_truth, from which the odometry pose differs
        self.assertIn('rgba="0.88 0.88 0.85 1"', rospy.get_param('/robot_description'))
        self.assertNotIn('/true_robot', dict(rospy.get_published_topics()))

    def test_the_parameters_of_create_node_are_set(self):
        params = rospy.get_param('/turtlebot_node')
        self.assertEqual({key: params[key] for key in ('operation_mode', 'gyro_scale_correction')},
                         {'operation_mode': 2, 'gyro_scale_correction': 1.35})
        self.assertFalse(rospy.get_param('/use_sim_time'))

    def test_it_obeys(self):
        commander = support.Commander()
        support.wait_for(lambda: commander.send(0.1) or self.odom.position()[0] > 0.05, 'the robot to move')
        support.wait_for(lambda: commander.send() or self.odom.last.twist.twist.linear.x == 0, 'the robot to stand')


if __name__ == '__main__':
    support.main(TestMinimalLaunch)
