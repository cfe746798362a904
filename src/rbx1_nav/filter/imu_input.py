"""The IMU of the filter, which may be mounted upside down or tilted: its mounting, and the parent of the robot's frame,
are read from the tree of frames that other nodes publish.
"""
from __future__ import annotations

from math import acos, degrees
import time
from typing import Callable, Tuple

import rospy
from sensor_msgs.msg import Imu as ImuMessage
from tf2_msgs.msg import TFMessage

from rbx1_nav.base.messages import unit_quaternion
from rbx1_nav.filter.conversions import from_imu
from rbx1_nav.filter.imu_mounting import UPRIGHT, GyroInput, Vector, inverse, multiply, vertical_axis
from rbx1_nav.filter.input_checks import Imu, check
from rbx1_nav.node.config import show

TRANSFORM_WARN_TIME = 1.0      # s of wall time to wait for a transform before a line is logged

Rotation = Tuple[float, float, float, float]    # quaternion (x, y, z, w)


class FrameTree:
    """Listens to /tf and /tf_static while the tree is needed. The node's own transforms are ignored.

    It keeps only the latest rotation of each frame, and does not need tf2_ros, which would take 5 MB.
    """

    def __init__(self) -> None:
        # by child: (parent, publishing node, rotation of the child in the parent)
        self.frames: dict[str, tuple[str, str, Rotation]] = {}
        self.subscribers: list[rospy.Subscriber] = []

    def listen(self, wanted: bool) -> None:
        """Start or stop listening."""
        if wanted and not self.subscribers:
            self.subscribers = [rospy.Subscriber(topic, TFMessage, self._on_transforms, tcp_nodelay=True)
                                for topic in ('/tf_static', '/tf')]
        while self.subscribers and not wanted:
            self.subscribers.pop().unregister()

    def publisher(self, child: str) -> tuple[str, str] | None:
        """Return (parent, publishing node) of the transform to a frame, or None."""
        return self.frames[child][:2] if child in self.frames else None

    def forget(self, child: str) -> None:
        self.frames.pop(child, None)

    def rotation(self, frame: str, other: str) -> Rotation | None:
        """Return the rotation of `other` in `frame`, a quaternion (x, y, z, w); None if they are not connected yet."""
        path = self._path(frame)
        return next((multiply(inverse(path[ancestor]), rotation)
                     for ancestor, rotation in self._path(other).items() if ancestor in path), None)

    def _path(self, frame: str) -> dict[str, Rotation]:
        """Return the rotations of a frame in itself and in all its ancestors."""
        rotation: Rotation = (0.0, 0.0, 0.0, 1.0)
        path: dict[str, Rotation] = {}
        while frame not in path:    # stops at a loop, which is an error of other nodes
            path[frame] = rotation
            if frame in self.frames:
                frame, _, turn = self.frames[frame]
                rotation = multiply(turn, rotation)
        return path

    def _on_transforms(self, message: TFMessage) -> None:
        node = message._connection_header['callerid']
        for transform in message.transforms if node != rospy.get_name() else ():
            rotation = unit_quaternion(transform.transform.rotation)
            if rotation:
                self.frames[transform.child_frame_id.lstrip('/')] = (
                    transform.header.frame_id.lstrip('/'), node, rotation)


class ImuInput:
    """Rotates the readings of an IMU to the robot's vertical axis, with a transform that is looked up once."""

    def __init__(self, topic: str, tree: FrameTree, log: Callable[[str], None]) -> None:
        self.topic = rospy.resolve_name(topic)
        self.tree = tree
        self.log = log
        self.gyro = GyroInput(lambda text: log(f'{self.topic}: {text}'))
        self.frames: tuple[str, str] | None = None      # frames of the robot and of the IMU
        self.vertical: Vector | None = None             # vertical_axis() for these frames

    @property
    def settled(self) -> bool:
        """Whether no transform is needed."""
        return self.frames is None or self.vertical is not None

    def read(self, message: ImuMessage, base_frame: str, accept: Callable[[Imu], None]) -> None:
        """Call accept(imu) with an Imu. base_frame: the robot's frame. Raises RejectedMessage, as accept() may."""
        frames = base_frame, message.header.frame_id.lstrip('/') or base_frame
        if frames != self.frames:
            self.frames, self.vertical = frames, None
            self.deadline = time.monotonic() + TRANSFORM_WARN_TIME      # s
        if self.vertical is None:
            self.vertical = self._find_vertical(*frames)
            if self.vertical is None:
                check('header.frame_id', show(frames[1]), time.monotonic() < self.deadline,
                      f'a transform from {base_frame} to it')
                return
        data = from_imu(message)
        accept(self.gyro.read(data, self.vertical))
        self.gyro.accepted(data)

    def _find_vertical(self, base_frame: str, frame: str) -> Vector | None:
        if frame == base_frame:
            return UPRIGHT
        rotation = self.tree.rotation(base_frame, frame)
        if rotation is None:
            return None
        vertical = vertical_axis(rotation)
        tilt = degrees(acos(max(-1.0, min(1.0, vertical[2]))))
        self.log(f'{self.topic}: rotating readings from {frame} to {base_frame}, vertical axis tilted by {tilt:.0f} '
                 'degrees')
        return vertical
