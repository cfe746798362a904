"""The tree of frames that other nodes publish: the parents of frames, and the rotations between frames."""
from __future__ import annotations

from typing import Tuple

import rospy
from tf2_msgs.msg import TFMessage

from rbx1_nav.estimation.gyro_input import inverse, multiply
from rbx1_nav.ros.messages import unit_quaternion

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
        """Forget the transform to a frame."""
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
