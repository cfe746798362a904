"""Reads a bag into a Recording."""
from __future__ import annotations

from typing import Mapping, NamedTuple

from genpy import Message
from geometry_msgs.msg import PoseStamped, Twist
from nav_msgs.msg import Odometry
import numpy
import rosbag
from sensor_msgs.msg import Imu

from rbx1_nav.base.kinematics import Pose
from rbx1_nav.base.messages import yaw_of
from rbx1_nav.base.units import Array
from rbx1_nav.extras.fitting.recording import Commands, Rates, Recording, Track, check_recording
from rbx1_nav.filter.input_checks import JUMP_TOLERANCE
from rbx1_nav.filter.priors import Bounds
from rbx1_nav.node.config import ConfigError, show_name


class TopicNames(NamedTuple):
    cmd_vel: str
    odom: str
    imu: str
    truth: str | None


TYPES: dict[str, tuple[type[Message], ...]] = {
    'cmd_vel': (Twist,), 'odom': (Odometry,), 'imu': (Imu,), 'truth': (Odometry, PoseStamped)}

# otherwise rosbag generates a class, as Python code, from the message definition in the bag, which may be untrusted
for _types in TYPES.values():
    for _type in _types:
        rosbag.bag._message_types[_type._md5sum] = _type


class TopicMessages:
    """The messages of one topic."""

    def __init__(self, topic: str, types: tuple[type[Message], ...]) -> None:
        self.topic = topic
        self.types = types
        self.other_types: set[str] = set()
        self.rows: list[tuple[float, ...]] = []

    def accepts(self, datatype: str, md5sum: str) -> bool:
        """Return whether a connection has messages of the expected type."""
        if any((one._type, one._md5sum) == (datatype, md5sum) for one in self.types):
            return True
        self.other_types.add(datatype)
        return False

    def add(self, message: Message, time: float) -> None:
        """Add a message. time: time of recording, s."""
        if isinstance(message, Twist):
            self.rows.append((time, message.linear.x, message.angular.z))
            return
        stamp = message.header.stamp.to_sec()
        if isinstance(message, Imu):
            self.rows.append((stamp, message.angular_velocity.z))
            return
        pose = message.pose.pose if isinstance(message, Odometry) else message.pose
        self.rows.append((stamp, pose.position.x, pose.position.y, yaw_of(pose.orientation)))

    def columns(self, width: int) -> Array:
        return numpy.array(self.rows, float).reshape(-1, width).T


def read_bag(path: str, topics: TopicNames, end: Pose | None = None) -> Recording:
    """Return the Recording of a bag; end: end pose measured by hand. Raises ConfigError."""
    name = show_name(path)
    series = {field: TopicMessages(topic, TYPES[field]) for field, topic in topics._asdict().items() if topic}
    by_topic = {f"/{one.topic.lstrip('/')}": one for one in series.values()}
    found: set[str] = set()

    def choose(topic: str, datatype: str, md5sum: str, _definition: str, _header: Mapping[str, str | bytes]) -> bool:
        one = by_topic.get(f"/{topic.lstrip('/')}")
        found.add(topic)
        return one is not None and one.accepts(datatype, md5sum)

    try:
        with rosbag.Bag(path) as bag:
            for topic, message, time in bag.read_messages(connection_filter=choose):
                by_topic[f"/{topic.lstrip('/')}"].add(message, time.to_sec())
    except Exception as error:
        # a damaged bag may cause any error, depending on the first wrong byte: struct.error, KeyError, MemoryError, ...
        raise ConfigError(f"{name}: expected a bag: {' '.join(str(error).split()) or type(error).__name__}") from error
    for one in by_topic.values():
        check(name, one)
    commands, odometry, imu, truth = series['cmd_vel'], series.get('odom'), series.get('imu'), series.get('truth')
    for required in (commands, truth):
        if required and not required.rows:
            expected = ' or '.join(each._type for each in required.types)
            raise ConfigError(f'{name}: {required.topic}: no messages of type {expected}: expected some; the bag has '
                              f"{', '.join(sorted(found)) or 'none at all'}")
    recording = check_recording(Recording(
        name, Commands(*commands.columns(3)), track(odometry), Rates(*imu.columns(2)) if imu and imu.rows else None,
        track(truth), end))
    check_jumps(name, topics.odom, recording.odometry)
    return recording


def check(name: str, series: TopicMessages) -> None:
    """Raise ConfigError if all messages have another type."""
    if series.other_types and not series.rows:
        raise ConfigError(f"{name}: {series.topic}: {', '.join(sorted(series.other_types))}: expected "
                          f"{' or '.join(one._type for one in series.types)}")


def track(series: TopicMessages | None) -> Track | None:
    """Return the Track of a TopicMessages with poses; None without messages."""
    if not (series and series.rows):
        return None
    time, x, y, yaw = series.columns(4)
    with numpy.errstate(invalid='ignore'):      # nan is rejected later
        return Track(time, x, y, numpy.unwrap(yaw))


def check_jumps(name: str, topic: str, poses: Track | None) -> None:
    """Raise ConfigError if the poses of a Track jump, because there are two robots or the robot was reset."""
    if poses is None:
        return
    steps = numpy.hypot(numpy.diff(poses.x), numpy.diff(poses.y))
    jumps = numpy.flatnonzero(steps > Bounds().max_speed * numpy.diff(poses.time) + JUMP_TOLERANCE)
    if len(jumps):
        first = jumps[0]
        elapsed = poses.time[first + 1] - poses.time[first]
        raise ConfigError(f'{name}: {topic}: jumps by {steps[first]:.2f} m in {elapsed:.3f} s, {len(jumps)} times in '
                          'all: expected one run of one robot')
