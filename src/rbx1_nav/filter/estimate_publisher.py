"""Publishes the combined odometry as a pose, as an odometry message with the robot's velocity, and as a transform."""
from __future__ import annotations

import time
from types import SimpleNamespace
from typing import Callable

import rospy
from geometry_msgs.msg import PoseWithCovarianceStamped, TwistWithCovariance
from nav_msgs.msg import Odometry
from tf2_msgs.msg import TFMessage

from rbx1_nav.base import messages
from rbx1_nav.base.kinematics import relative_frame
from rbx1_nav.base.schedule import Schedule
from rbx1_nav.base.units import SECOND
from rbx1_nav.filter.combined_odometry import CombinedOdometry
from rbx1_nav.filter.imu_input import FrameTree
from rbx1_nav.node.rospy_connections import NoDelay

TRANSFORM_TIME = 2 * SECOND   # ns after the first estimate to wait for a transform to the robot's frame
MIN_WAIT = 1.0          # minimum wall time (s) to wait for it: connecting takes time, however fast simulated time is


def twist_message(combined: CombinedOdometry) -> TwistWithCovariance:
    """Return the velocity in the robot's frame, which is unknown before the first step."""
    message = TwistWithCovariance(covariance=messages.diagonal(*[messages.UNKNOWN] * 6))
    found = combined.velocity
    if found:
        message.twist.linear.x, message.twist.linear.y, message.twist.angular.z = found[:3]
        message.covariance[0], message.covariance[7] = found.forward_variance, found.left_variance
        message.covariance[35] = found.turn_variance
    return message


class EstimatePublisher:
    """Publishes Estimates at a given rate.

    The transform is from the output frame to the robot's frame, as in robot_pose_ekf. A frame has only one parent: if
    another node publishes a transform to the robot's frame, this transform is to the odometry frame instead.
    """

    def __init__(self, parameters: SimpleNamespace, tree: FrameTree, log: Callable[[str], None]) -> None:
        """parameters: see read_parameters(); log(text): logs a line."""
        self.output_frame = parameters.output_frame
        self.publish_tf = parameters.publish_tf
        self.tree = tree
        self.log = log
        self.schedule = Schedule(parameters.freq)
        self.pose_pub = rospy.Publisher('~odom_combined', PoseWithCovarianceStamped, NoDelay(), queue_size=10)
        self.odometry_pub = rospy.Publisher('~odometry', Odometry, NoDelay(), queue_size=10)
        self.tf_pub = rospy.Publisher('/tf', TFMessage, NoDelay(), queue_size=100)
        self.frames = '', ''        # frames of the odometry and of the robot; '': not known yet
        self.published = 0          # number of poses
        self.restart()

    def restart(self) -> None:
        """Determine again which node publishes the transform to the robot's frame."""
        self.tree.forget(self.frames[1])
        self.child = ''                         # child frame of the transform; '' until it is known
        self.settled = not self.publish_tf      # whether transforms of other nodes are no longer needed
        self.first: tuple[int, float] | None = None     # (ns, s of wall time) of the first estimate

    def update(self, combined: CombinedOdometry, odom_frame: str, base_frame: str) -> None:
        """Publish the estimate if it is due. odom_frame, base_frame: the frames of its odometry."""
        estimate = combined.estimate
        if not (estimate and self.schedule.due(estimate.stamp)):
            return
        stamp = rospy.Time(0, estimate.stamp)
        pose = messages.planar_pose(stamp, self.output_frame, estimate.pose, estimate.covariance)
        self.pose_pub.publish(pose)
        self.published += 1
        if self.odometry_pub.get_num_connections():     # this message takes longer to create than the pose
            self.odometry_pub.publish(Odometry(pose.header, base_frame, pose.pose, twist_message(combined)))
        if not self.publish_tf:
            return
        if self.frames != (odom_frame, base_frame):
            self.frames = odom_frame, base_frame
            self.restart()
        self._choose_child(estimate.stamp, odom_frame, base_frame)
        if self.child:
            there = estimate.pose if self.child == base_frame else relative_frame(estimate.pose, estimate.odom.pose)
            self.tf_pub.publish([messages.transform(stamp, self.output_frame, self.child, there)])

    def _choose_child(self, now: int, odom_frame: str, base_frame: str) -> None:
        """Set `child`. now: ns."""
        other = self.tree.publisher(base_frame)
        if self.output_frame == odom_frame:
            self._set_child(base_frame, 'the odometry is in the same frame')
            self.settled = True
        elif other:
            self._set_child(odom_frame, f'{other[1]} already publishes {other[0]} -> {base_frame}')
            self.settled = True
        elif self.first is None or now < self.first[0]:     # also after the clock has jumped back
            self.first = now, time.monotonic()
        elif now - self.first[0] >= TRANSFORM_TIME and time.monotonic() - self.first[1] >= MIN_WAIT:
            self._set_child(base_frame, f'no other node publishes a transform to {base_frame}')

    def _set_child(self, child: str, why: str) -> None:
        if child != self.child:
            self.child = child
            self.log(f'Publishing the transform {self.output_frame} -> {child} ({why})')
