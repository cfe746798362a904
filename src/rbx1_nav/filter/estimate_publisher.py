"""Publishes the combined odometry as a pose, as an odometry message with the robot's velocity, and as a transform."""
from __future__ import annotations

from math import cos, sin
import time
from types import SimpleNamespace
from typing import Callable

import rospy
from geometry_msgs.msg import PoseWithCovarianceStamped, TwistWithCovariance
from nav_msgs.msg import Odometry
from tf2_msgs.msg import TFMessage

from rbx1_nav.base import messages
from rbx1_nav.base.kinematics import relative_frame
from rbx1_nav.base.readings import MEASURED
from rbx1_nav.base.schedule import Schedule
from rbx1_nav.base.surfaces import CELL_TRAVELLED, CELL_TURNED
from rbx1_nav.base.units import SECOND, wrap_angle
from rbx1_nav.filter.combined_odometry import CombinedOdometry, Estimate
from rbx1_nav.filter.filter import BIAS, CARRY_SPEED, SCALE, SLIP_STRAIGHT, SLIP_TURNING, Filter
from rbx1_nav.filter.sensor_inputs import FrameTree
from rbx1_nav.filter.sensors import IMU
from rbx1_nav.node.rospy_topics import NoDelay

TRANSFORM_TIME = 2 * SECOND   # ns after the first estimate to wait for a transform to the robot's frame
MIN_WAIT = 1.0          # minimum wall time (s) to wait for it: connecting takes time, however fast simulated time is


def _of_floor(noise: float, speed: float, elapsed: float, cell: float) -> float:
    """Return the variance of a speed due to the noise of a floor, which is constant within a cell and averages out over
    several cells."""
    return noise ** 2 * speed ** 2 / max(cell, speed * elapsed)


def estimate_twist(combined: CombinedOdometry, before: Estimate | None) -> TwistWithCovariance:
    """Return the mean velocity from the Estimate `before` to the latest one, in the robot's frame; with unknown
    variances if there is none before, or their stamps are equal.

    The displacement comes from the odometry, reduced by the slip of the assumed floor, and the turn comes from the
    filter. While the robot is carried, its wheels do not measure its motion.
    """
    message = TwistWithCovariance(covariance=messages.diagonal(*[messages.UNKNOWN] * 6))
    last, ekf = combined.estimate, combined.filter
    if not (before and last and ekf and last.stamp > before.stamp):
        return message
    elapsed = (last.stamp - before.stamp) / SECOND
    prior = ekf.prior
    turn = wrap_angle(last.pose.yaw - before.pose.yaw) / elapsed
    start, end = before.odom.pose, last.odom.pose
    turned = wrap_angle(end.yaw - start.yaw)
    c, s = cos(start.yaw + turned / 2), sin(start.yaw + turned / 2)
    share = (1 - prior.slip_straight) / elapsed
    dx, dy = end.x - start.x, end.y - start.y
    forward, left = (dx * c + dy * s) * share, (dy * c - dx * s) * share
    by_wheels = turned / elapsed
    forward_variance = left_variance = CARRY_SPEED ** 2
    if combined.case != 'carried':
        slip = ekf.sigma(SLIP_STRAIGHT) ** 2
        floor = _of_floor(prior.distance_noise, abs(forward), elapsed, CELL_TRAVELLED)
        forward_variance = MEASURED + max(last.odom.linear_variance, floor) + slip * forward ** 2
        left_variance = MEASURED + slip * left ** 2      # wheels do not roll sideways

    imu = combined.readings.last if combined.gyro_used and not combined.timed_out[IMU] else None
    if imu:
        step = last.stamp - before.stamp
        # the noise averages out over the readings of the step
        averaged = imu.variance * min(1.0, (combined.readings.period or step) / step)
        turn_variance = averaged + ekf.sigma(BIAS) ** 2 + (ekf.sigma(SCALE) * turn) ** 2
        if combined.case == 'contradiction':    # either wheels or gyro are wrong
            turn_variance += (by_wheels * (1 - prior.slip_turning) - turn) ** 2
    else:
        floor = (_of_floor(prior.heading_noise_turning, abs(by_wheels), elapsed, CELL_TURNED)
                 + _of_floor(prior.heading_noise_straight, abs(forward), elapsed, CELL_TRAVELLED))
        turn_variance = max(last.odom.angular_variance, floor) + (ekf.sigma(SLIP_TURNING) * turn) ** 2
    message.twist.linear.x, message.twist.linear.y, message.twist.angular.z = forward, left, turn
    message.covariance = messages.diagonal(
        forward_variance, left_variance, messages.UNKNOWN, messages.UNKNOWN, messages.UNKNOWN, MEASURED + turn_variance)
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
        self.last: Estimate | None = None       # the latest Estimate
        self.before: Estimate | None = None     # the Estimate before it, if there was no jump in between
        self.filter: Filter | None = None       # the Filter of `last`
        self.placed = False                     # whether set_pose may move the next Estimate to another pose
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
        if not estimate:
            return
        if estimate is not self.last:
            self.before = None if self.placed or combined.filter is not self.filter else self.last
            self.last, self.filter = estimate, combined.filter
        self.placed = combined.placed is not None
        if not self.schedule.due(estimate.stamp):
            return
        stamp = rospy.Time(0, estimate.stamp)
        pose = messages.planar_pose(stamp, self.output_frame, estimate.pose, estimate.covariance)
        self.pose_pub.publish(pose)
        self.published += 1
        if self.odometry_pub.get_num_connections():     # this message takes longer to create than the pose
            self.odometry_pub.publish(Odometry(pose.header, base_frame, pose.pose,
                                               estimate_twist(combined, self.before)))
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
