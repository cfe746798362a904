"""Looks up the robot's pose with tf2, for odometry-based driving scripts, which also import their legs from here."""
from __future__ import annotations

from math import atan2

import rospy
from geometry_msgs.msg import TransformStamped
from std_msgs.msg import Empty
import tf2_ros
import yaml

from rbx1_nav.base.kinematics import Pose
from rbx1_nav.base.units import wrap_angle
from rbx1_nav.driving.rate import wait_for_tick
from rbx1_nav.driving.stopping import halt
from rbx1_nav.exercise.legs import Straight, Turn, is_reachable
from rbx1_nav.node.life import wait_for
from rbx1_nav.node.private_parameters import param
from rbx1_nav.node.tf_prefix import resolve_frame

MAX_AGE = 0.5       # s: older transforms are not used
STATIONARY = 0.4    # s without a look at the pose, after which the robot is known to be at rest; less than TRIAL_REST
COMBINED_FRAME = 'odom_combined'    # the filter's output frame, see rbx1_bringup/launch
BASE_FRAMES = ('base_footprint', 'base_link')   # usual names of a robot's base frame, REP 105 and REP 120

__all__ = ['PoseListener', 'Straight', 'Turn']


def format_pose(pose: Pose) -> str:
    """Return a Pose as text."""
    return f'({pose.x:.3f} m, {pose.y:.3f} m, {wrap_angle(pose.yaw):.3f} rad)'


class LostTransform(Exception):
    """There is no recent transform. The text names the frames."""


class PoseListener:
    """Looks up the pose of the robot's base in a frame."""

    def __init__(self, odom_frame: str, base_frame: str | None, linear_speed: float, angular_speed: float,
                 transform_timeout: float | None = None) -> None:
        """odom_frame, base_frame: names, to which the tf_prefix of the robot is added; base_frame may be None, for the
        first of BASE_FRAMES that exists; speeds of the robot: m/s, rad/s; transform_timeout: time for which the stopped
        robot waits for a missing pose, s; None: a missing pose is an error. Raises ROSException."""
        self.transform_timeout = transform_timeout
        self.speeds = linear_speed, angular_speed
        self.odom_frame = resolve_frame(odom_frame.lstrip('/'))     # old scripts have a slash
        self.base_frames = [resolve_frame(each.lstrip('/')) for each in ([base_frame] if base_frame else BASE_FRAMES)]
        self.buffer = tf2_ros.Buffer()
        self.listener = tf2_ros.TransformListener(self.buffer)
        self.reset = False  # whether the base was reset
        self.reset_sub = rospy.Subscriber('reset_odometry', Empty, self._on_reset)
        self.last: tuple[float, Pose] | None = None     # stamp (s) and Pose of the last transform
        self.velocity = Pose(0.0, 0.0, 0.0)     # between the last two transforms, m/s and rad/s

    @property
    def base_frame(self) -> str:
        """The frame of the robot, or the candidates for it."""
        return ' or '.join(self.base_frames)

    def pose(self) -> Pose:
        """Return the current Pose, extrapolated from the last two transforms; the yaw is not wrapped.

        The first pose may take up to ~wait_timeout s. If a later one is missing, stops the robot and waits for it.
        Raises ROSException if there is no pose, the base was reset since the first pose, or the pose has jumped, and
        ROSInterruptException as soon as shutdown is requested.
        """
        if not self.last:
            self._wait(param('wait_timeout'))
            rospy.loginfo('Measuring the pose of %s in the frame %s', self.base_frame, self.odom_frame)
            wait_for_tick()
        try:
            return self._pose()
        except LostTransform as error:
            if self.transform_timeout is None:
                raise rospy.ROSException(f'The base no longer reports odometry ({error}): expected a base that is '
                                         'connected to its robot; see /diagnostics') from None
            halt()
            rospy.logwarn('%s: stopping the robot until there is a new one', error)
            return self._wait(self.transform_timeout)

    def _pose(self) -> Pose:
        """Return the current Pose. Raises LostTransform, and ROSException."""
        if self.reset:
            raise rospy.ROSException('The base was reset during the run: its pose is no longer measured from the start')
        transform = self._look_up()
        stamp = transform.header.stamp.to_sec()
        age = rospy.get_time() - stamp
        if not -MAX_AGE <= age <= MAX_AGE:
            raise LostTransform(f'The last transform from {self.odom_frame} to {transform.child_frame_id} '
                                f'is {age:.2f} s old')
        position, rotation = transform.transform.translation, transform.transform.rotation
        pose = Pose(position.x, position.y, 2 * atan2(rotation.z, rotation.w))
        # where the robot can be after this time
        if self.last and not is_reachable(self.last[1], pose, stamp - self.last[0], *self.speeds):
            raise rospy.ROSException(f'The pose of {self.base_frame} in {self.odom_frame} jumped from '
                                     f'{format_pose(self.last[1])} to {format_pose(pose)}: was the base restarted?')
        self._update(stamp, pose)
        return Pose(*(value + rate * max(age, 0.0) for value, rate in zip(pose, self.velocity)))

    def _wait(self, timeout: float) -> Pose:
        """Wait for a pose, and return it. Raises ROSException after `timeout` s of wall time, ROSInterruptException."""
        problem: LostTransform | None = None

        def find() -> Pose | None:
            nonlocal problem
            try:
                return self._pose()
            except LostTransform as error:
                problem = error
            return None
        return wait_for(find, timeout, lambda: f"the robot's pose: {problem}")

    def _on_reset(self, _: Empty) -> None:
        self.reset = self.last is not None

    def _update(self, stamp: float, pose: Pose) -> None:
        elapsed = stamp - self.last[0] if self.last else 0.0
        if not 0 <= elapsed < STATIONARY:       # the robot may have coasted since then, but it has been stopped
            self.velocity = Pose(0.0, 0.0, 0.0)
        elif elapsed and self.last:
            before = self.last[1]
            self.velocity = Pose((pose.x - before.x) / elapsed, (pose.y - before.y) / elapsed,
                                 wrap_angle(pose.yaw - before.yaw) / elapsed)
        self.last = stamp, pose

    def _look_up(self) -> TransformStamped:
        for frame in self.base_frames:
            try:
                transform = self.buffer.lookup_transform(self.odom_frame, frame, rospy.Time(0))
            except tf2_ros.TransformException:
                continue
            self.base_frames = [frame]      # from now on, only this frame
            return transform
        raise LostTransform(f'There is no transform from {self.odom_frame} to {self.base_frame}{self._known_frames()}')

    def _known_frames(self) -> str:
        """Return the last part of a message: the list of existing frames, if one of ours does not exist."""
        tree = yaml.safe_load(self.buffer.all_frames_as_yaml()) or {}
        frames = set(tree) | {frame['parent'] for frame in tree.values()}
        if not frames or self.odom_frame in frames and frames.intersection(self.base_frames):
            return ''
        existing = f"; frames that exist: {', '.join(sorted(frames))}"
        if self.odom_frame == resolve_frame(COMBINED_FRAME) and self.odom_frame not in frames:
            robot = rospy.get_namespace().strip('/')
            existing += f'. To start the filter that publishes {COMBINED_FRAME}: roslaunch rbx1_bringup odom_ekf.launch'
            existing += f' robot:={robot}' if robot else ''
        return existing
