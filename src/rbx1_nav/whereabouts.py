"""Where the robot is, as tf2 tells it: for a driving script that wants to look, and not only to count."""
from math import atan2, pi, remainder
import time

import rospy
import tf2_ros

from rbx1_nav.diff_drive import Pose
from rbx1_nav.node import end_requested, sleep

STALE = 0.5     # s: a transform that is older tells of another place
BASE_FRAMES = ('base_footprint', 'base_link')   # what a robot may call its base, REP 105 and REP 120


class LostTransform(Exception):
    """Nobody tells where the robot is. The text names the frames."""


class Whereabouts:
    """The pose of the robot's base in a frame."""

    def __init__(self, odom_frame, base_frame):
        """base_frame: a name; or None for the first of BASE_FRAMES that is there."""
        self.odom_frame = odom_frame
        self.base_frames = [base_frame] if base_frame else BASE_FRAMES
        self.buffer = tf2_ros.Buffer()
        self.listener = tf2_ros.TransformListener(self.buffer)
        self.last = None    # (stamp in s, Pose)
        self.speed = Pose(0.0, 0.0, 0.0)    # of the last two, m/s and rad/s

    def pose(self):
        """The Pose now, its yaw within two turns of 0. Raises LostTransform.

        A transform tells where the robot was when it was stamped. Since then it went on as before, or nearly so.
        """
        transform = self._look_up()
        stamp = transform.header.stamp.to_sec()
        age = rospy.get_time() - stamp
        if not -STALE <= age <= STALE:
            raise LostTransform('The last transform from %s to %s is %.2f s old'
                                % (self.odom_frame, transform.child_frame_id, age))
        place, rotation = transform.transform.translation, transform.transform.rotation
        pose = Pose(place.x, place.y, 2 * atan2(rotation.z, rotation.w))
        if self.last is None or stamp < self.last[0]:
            self.speed = Pose(0.0, 0.0, 0.0)
        elif stamp > self.last[0]:
            elapsed, before = stamp - self.last[0], self.last[1]
            self.speed = Pose((pose.x - before.x) / elapsed, (pose.y - before.y) / elapsed,
                              remainder(pose.yaw - before.yaw, 2 * pi) / elapsed)
        self.last = stamp, pose
        return Pose(*(value + speed * max(age, 0.0) for value, speed in zip(pose, self.speed)))

    def wait(self, timeout):
        """pose() as soon as there is one. Raises ROSException after `timeout` s of wall time, ROSInterruptException."""
        give_up = time.monotonic() + timeout
        say_time = time.monotonic() + 0.5
        while True:
            try:
                return self.pose()
            except LostTransform as error:
                if time.monotonic() > give_up:
                    raise rospy.ROSException('Waited %g s in vain for the robot\'s pose. %s' % (timeout, error))
                if time.monotonic() > say_time:
                    say_time += 5
                    rospy.loginfo('Waiting for the robot\'s pose. %s', error)
            sleep(0.02)
            if end_requested.is_set():
                raise rospy.ROSInterruptException('asked to end')

    def _look_up(self):
        for frame in self.base_frames:
            try:
                transform = self.buffer.lookup_transform(self.odom_frame, frame, rospy.Time(0))
            except tf2_ros.TransformException:
                continue
            self.base_frames = [frame]      # from now on this one
            return transform
        raise LostTransform('There is no transform from %s to %s' % (self.odom_frame, ' or '.join(self.base_frames)))
