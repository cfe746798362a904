#!/usr/bin/python3
"""The transform leads to the robot's frame, even without child_frame_id, until another node publishes one to it."""
import rospy
from geometry_msgs.msg import TransformStamped
from nav_msgs.msg import Odometry
from rosgraph_msgs.msg import Log
from tf2_msgs.msg import TFMessage

import support


class TestRobotFrame(support.Case):
    def test_which_frame_the_transform_leads_to(self):
        log, transforms = support.Watch('/rosout', Log), support.Watch('/tf', TFMessage)
        odometry = rospy.Publisher('/odom', Odometry, queue_size=10)
        others = rospy.Publisher('/tf', TFMessage, queue_size=10)

        def children(child_frame_id=''):
            """Return the frames of the filter's latest transform after one more odometry message."""
            message = Odometry()
            message.header.frame_id, message.header.stamp = 'odom', rospy.Time.now()
            message.child_frame_id = child_frame_id
            message.pose.pose.orientation.w = 1.0
            message.pose.covariance[::7] = [1e-6] * 6
            odometry.publish(message)
            rospy.rostime.wallsleep(0.02)
            return [(t.header.frame_id, t.child_frame_id) for m in list(transforms.messages) for t in m.transforms
                    if m._connection_header['callerid'] == '/robot_pose_ekf'][-1:]

        def has_logged(text):
            return any(m.name == '/robot_pose_ekf' and text in m.msg for m in list(log.messages))
        support.wait_for(lambda: children() == [('robot/odom_combined', 'robot/base_footprint')],
                         'the transform to the frame of the robot')
        support.wait_for(lambda: has_logged('-> robot/base_footprint (no other node publishes'), 'the line')

        # the base starts to publish its own transform
        base = TransformStamped()
        base.header.frame_id, base.child_frame_id = 'odom', 'robot/base_footprint'
        base.transform.rotation.w = 1.0
        support.wait_for(lambda: others.publish([base]) or children() == [('robot/odom_combined', 'odom')],
                         'the transform to the odometry')
        support.wait_for(lambda: has_logged('Publishing the transform robot/odom_combined -> odom (/robot_frame'),
                         'the line')

        # another robot, whose odometry names its frame
        support.wait_for(lambda: children('base_link') == [('robot/odom_combined', 'base_link')],
                         'the transform to the other frame')


if __name__ == '__main__':
    support.main(TestRobotFrame)
