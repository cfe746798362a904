"""Reads a bag to a Recording."""
from collections import namedtuple

from geometry_msgs.msg import PoseStamped, Twist
from nav_msgs.msg import Odometry
import numpy
import rosbag
from sensor_msgs.msg import Imu

from rbx1_nav.config import ConfigError, show_name
from rbx1_nav.estimation.combined_odometry import JUMP_TOLERANCE
from rbx1_nav.estimation.limits import Limits
from rbx1_nav.fitting.recording import Commands, Rates, Recording, Track, check_recording
from rbx1_nav.ros.messages import yaw_of

Topics = namedtuple('Topics', 'cmd_vel odom imu truth')
Topics.__doc__ = 'Names of topics; truth may be None.'

TYPES = Topics((Twist,), (Odometry,), (Imu,), (Odometry, PoseStamped))

# otherwise rosbag generates a class, as Python code, from the definition in the bag: whoever wrote the bag wrote that
for _type in set(sum(TYPES, ())):
    rosbag.bag._message_types[_type._md5sum] = _type     # pylint: disable=protected-access


class Series:
    """The messages of one topic."""

    def __init__(self, topic, types):
        self.topic = topic
        self.types = types
        self.other_types = set()
        self.senders = {}       # (name of a node, child frame) of those that published it
        self.rows = []

    def accepts(self, datatype, md5sum):
        """Whether a connection has messages of the expected type."""
        if any((one._type, one._md5sum) == (datatype, md5sum) for one in self.types):
            return True
        self.other_types.add(datatype)
        return False

    def add(self, message, time, header):
        """Add a message. time: s, when it was recorded."""
        name = header.get('callerid', 'an unknown node')    # rosbag leaves it undecoded
        self.senders[name.decode(errors='replace') if isinstance(name, bytes) else name,
                     getattr(message, 'child_frame_id', None)] = True
        if isinstance(message, Twist):
            self.rows.append((time, message.linear.x, message.angular.z))
            return
        stamp = message.header.stamp.to_sec()
        if isinstance(message, Imu):
            self.rows.append((stamp, message.angular_velocity.z))
            return
        pose = message.pose.pose if isinstance(message, Odometry) else message.pose
        self.rows.append((stamp, pose.position.x, pose.position.y, yaw_of(pose.orientation)))

    def columns(self, width):
        """One array for each value."""
        return numpy.array(self.rows, float).reshape(-1, width).T


def read_bag(path, topics, end=None):
    """The Recording of a bag; topics: Topics; end: Pose measured by hand. Raises ConfigError."""
    name = show_name(path)
    series = Topics(*(topic and Series(topic, types) for topic, types in zip(topics, TYPES)))
    by_topic = {f"/{one.topic.lstrip('/')}": one for one in series if one}
    found = set()

    def choose(topic, datatype, md5sum, *_):
        one = by_topic.get(f"/{topic.lstrip('/')}")
        found.add(topic)
        return one is not None and one.accepts(datatype, md5sum)

    try:
        with rosbag.Bag(path) as bag:
            for topic, message, time, header in bag.read_messages(connection_filter=choose,
                                                                  return_connection_header=True):
                by_topic[f"/{topic.lstrip('/')}"].add(message, time.to_sec(), header)
    except Exception as error:      # pylint: disable=broad-except
        # a damaged bag ends in whatever the first wrong byte leads to: struct.error, KeyError, MemoryError, ...
        raise ConfigError(f"{name}: expected a bag: {' '.join(str(error).split()) or type(error).__name__}")
    for one in by_topic.values():
        check(name, one)
    required = [series.cmd_vel] + ([series.truth] if series.truth else [])
    for one in required:
        if not one.rows:
            raise ConfigError('%s: %s: no messages of type %s: expected some; the bag has %s'
                              % (name, one.topic, ' or '.join(each._type for each in one.types),
                                 ', '.join(sorted(found)) or 'none at all'))
    recording = check_recording(Recording(
        name, Commands(*series.cmd_vel.columns(3)),
        track(series.odom), Rates(*series.imu.columns(2)) if series.imu and series.imu.rows else None,
        track(series.truth), end))
    check_jumps(name, series.odom, recording.odometry)
    return recording


def check(name, series):
    """Raise ConfigError for messages of another type, or of two robots."""
    if series.other_types and not series.rows:
        raise ConfigError('%s: %s: %s: expected %s' % (name, series.topic, ', '.join(sorted(series.other_types)),
                                                       ' or '.join(one._type for one in series.types)))
    # but a learner may steer by hand besides a script
    if len(series.senders) > 1 and series.types != TYPES.cmd_vel:
        raise ConfigError('%s: %s: published by %s: expected one robot'
                          % (name, series.topic, ' and '.join(
                              '%s (%s)' % tuple(map(show_name, sender)) if sender[1] else show_name(sender[0])
                              for sender in sorted(series.senders, key=str))))


def track(series):
    """The Track of a Series with poses; None without messages."""
    if not (series and series.rows):
        return None
    time, x, y, yaw = series.columns(4)
    return Track(time, x, y, numpy.unwrap(yaw))


def check_jumps(name, series, poses):
    """Raise ConfigError if the poses of a Track jump as those of no robot: there are two, or it was reset."""
    if poses is None:
        return
    steps = numpy.hypot(numpy.diff(poses.x), numpy.diff(poses.y))
    jumps = numpy.flatnonzero(steps > Limits().max_speed * numpy.diff(poses.time) + JUMP_TOLERANCE)
    if len(jumps):
        first = jumps[0]
        raise ConfigError('%s: %s: jumps by %.2f m in %.3f s, %d times in all: expected one run of one robot' % (
            name, series.topic, steps[first], poses.time[first + 1] - poses.time[first], len(jumps)))
