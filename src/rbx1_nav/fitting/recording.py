"""A recorded run: what was commanded, what the robot's sensors reported, and where the robot really was.

Times are in s, on one clock; all arrays of a series have one value per time.
"""
from collections import namedtuple

import numpy

from rbx1_nav.config import ConfigError
from rbx1_nav.units import SECOND

LARGEST = 1e10      # s, m, ...: no number of a run is larger
MIN_TRAVEL, MIN_TURN = 0.02, 0.1    # m, rad: less is no motion

Commands = namedtuple('Commands', 'time linear angular')
Commands.__doc__ = 'Each is in force until the next: m/s forward, rad/s to the left.'

Track = namedtuple('Track', 'time x y yaw')
Track.__doc__ = 'Poses: x and y in m, yaw in rad, not wrapped.'

Rates = namedtuple('Rates', 'time rate')
Rates.__doc__ = 'A gyro: rad/s.'

Recording = namedtuple('Recording', 'name commands odometry gyro truth end')
Recording.__doc__ = """name: for messages; commands: Commands; odometry: Track by the wheels; gyro: Rates; truth: Track;
end: Pose in the frame of the first pose, measured by hand. All but name and commands may be None."""


def check_series(name, series):
    """Raise ConfigError unless all values of a Commands, Track or Rates are finite, and its stamps never go back.

    name: what to call the series, with its file.
    """
    for field, values in zip(series._fields, series):
        bad = numpy.flatnonzero(~(abs(values) < LARGEST))
        if bad.size:
            raise ConfigError('%s: %s of message %d: %s: expected a finite number below 1e10'
                              % (name, field, bad[0] + 1, values[bad[0]]))
    back = numpy.flatnonzero(numpy.diff(series.time) < 0)
    if back.size:
        before, after = series.time[back[0]:back[0] + 2]
        raise ConfigError('%s: stamp of message %d: %.3f s before that of message %d: expected stamps that never go '
                          'back' % (name, back[0] + 2, before - after, back[0] + 1))


def check_recording(recording):
    """Raise ConfigError unless a Recording has commands, motion, and series without mistakes on one clock. Returns it.
    """
    name, commands = recording.name, recording.commands
    if not len(commands.time):
        raise ConfigError(f'{name}: no commands: expected the velocity commands of a run')
    for field in ('commands', 'odometry', 'gyro', 'truth'):
        series = getattr(recording, field)
        if series is not None:
            check_series(f'{name}: {field}', series)
    if not (numpy.any(commands.linear) or numpy.any(commands.angular)):
        raise ConfigError(f'{name}: no motion: expected commands other than 0')
    for field in ('odometry', 'gyro', 'truth'):
        series = getattr(recording, field)
        if series is None:
            continue
        first, last = max(series.time[0], commands.time[0]), min(series.time[-1], commands.time[-1])
        if not last - first > 0.5 * (commands.time[-1] - commands.time[0]):
            raise ConfigError('%s: %s from %.1f to %.1f s, but commands from %.1f to %.1f s: expected the same time, '
                              'by one clock' % (name, field, series.time[0], series.time[-1], *commands.time[[0, -1]]))
        if field != 'gyro' and not (max(numpy.ptp(series.x), numpy.ptp(series.y)) > MIN_TRAVEL
                                    or numpy.ptp(series.yaw) > MIN_TURN):
            raise ConfigError(f'{name}: {field}: no motion, although it was commanded: expected a robot that moves')
    return recording


def in_force(commands, robot):
    """The Commands that a base puts in force: within the limits of a Robot, and until they time out."""
    time, linear, angular = commands
    linear = numpy.clip(linear, -robot.limits.linear, robot.limits.linear)
    angular = numpy.clip(angular, -robot.limits.angular, robot.limits.angular)
    timeout = robot.timeout / SECOND
    if timeout:
        late = numpy.flatnonzero(numpy.diff(time, append=numpy.inf) > timeout)
        time, linear, angular = (numpy.insert(values, late + 1, more) for values, more in (
            (time, time[late] + timeout), (linear, 0.0), (angular, 0.0)))
    return Commands(time, linear, angular)


def relative(pose, other):
    """The pose `other` (x, y in m, yaw in rad) in the frame of `pose`, as an array; each may be many poses."""
    x, y = other[0] - pose[0], other[1] - pose[1]
    c, s = numpy.cos(pose[2]), numpy.sin(pose[2])
    return numpy.array([c * x + s * y, c * y - s * x, other[2] - pose[2]])
