"""Reads an IMU that may be mounted upside down or tilted, and may send only an orientation."""
from __future__ import annotations

from math import acos, degrees
import time
from typing import Callable

import rospy
from sensor_msgs.msg import Imu as ImuMessage

from rbx1_nav.config import show
from rbx1_nav.estimation.gyro_input import UPRIGHT, GyroInput, Vector, vertical_axis
from rbx1_nav.estimation.inputs import Imu, check
from rbx1_nav.ros import messages
from rbx1_nav.ros.filter.frame_tree import FrameTree

TRANSFORM_WARN_TIME = 1.0      # s of wall time to wait for a transform before a line is logged


class ImuInput:
    """Rotates the readings of an IMU to the robot's vertical axis, with a transform that is looked up once."""

    def __init__(self, topic: str, tree: FrameTree, log: Callable[[str], None]) -> None:
        """log(text): logs a line."""
        self.topic = rospy.resolve_name(topic)
        self.tree = tree
        self.log = log
        self.gyro = GyroInput(lambda text: log(f'{self.topic}: {text}'))
        self.frames: tuple[str, str] | None = None      # frames of the robot and of the IMU
        self.vertical: Vector | None = None             # vertical_axis() for these frames
        self.deadline = 0.0                             # s of the monotonic clock

    @property
    def settled(self) -> bool:
        """Whether no transform is needed."""
        return self.frames is None or self.vertical is not None

    def read(self, message: ImuMessage, base_frame: str, accept: Callable[[Imu], None]) -> None:
        """Call accept(imu) with an Imu. base_frame: the robot's frame. Raises RejectedMessage, as accept() may."""
        frames = base_frame, message.header.frame_id.lstrip('/') or base_frame
        if frames != self.frames:
            self.frames, self.vertical, self.deadline = frames, None, time.monotonic() + TRANSFORM_WARN_TIME
        if self.vertical is None:
            self.vertical = self._find_vertical(*frames)
            if self.vertical is None:
                check('header.frame_id', show(frames[1]), time.monotonic() < self.deadline,
                      f'a transform from {base_frame} to it')
                return
        data = messages.from_imu(message)
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
