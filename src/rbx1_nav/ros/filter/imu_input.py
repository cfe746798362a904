"""Reads an IMU that may be mounted upside down or askew, and may send an orientation only."""
from math import acos, degrees
import time

import rospy

from rbx1_nav.config import show
from rbx1_nav.estimation.gyro_input import UPRIGHT, GyroInput, vertical_axis
from rbx1_nav.estimation.inputs import check
from rbx1_nav.ros import messages

TRANSFORM_WARN_TIME = 1.0      # s of wall time for a transform to arrive before a line is logged


class ImuInput:
    """Turns the readings of an IMU to the robot's vertical axis, by a transform that is looked up once."""

    def __init__(self, topic, tree, log):
        """topic: name; tree: FrameTree; log(text): logs a line."""
        self.topic = rospy.resolve_name(topic)
        self.tree = tree
        self.log = log
        self.gyro = GyroInput(lambda text: log(f'{self.topic}: {text}'))
        self.frames = self.vertical = None      # frames of the robot and of the IMU, and vertical_axis() for them
        self.deadline = None

    @property
    def settled(self):
        """Whether no transform is needed now."""
        return self.frames is None or self.vertical is not None

    def read(self, message, base_frame, accept):
        """Call accept(imu) with an Imu. base_frame: of the robot. Raises RejectedMessage, as accept() may."""
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

    def _find_vertical(self, base_frame, frame):
        if frame == base_frame:
            return UPRIGHT
        rotation = self.tree.rotation(base_frame, frame)
        if rotation is None:
            return None
        vertical = vertical_axis(rotation)
        self.log('%s: turned from %s to %s, its vertical axis by %.0f degrees'
                 % (self.topic, frame, base_frame, degrees(acos(max(-1.0, min(1.0, vertical[2]))))))
        return vertical
