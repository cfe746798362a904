"""A recorded run: what was commanded, what the robot's sensors reported, and where the robot really was.

Times are in s, on one clock. All arrays of a series have one value per time. Recordings are also read from the text
files of the UTIAS Multi-Robot Cooperative Localization and Mapping Dataset (K. Y. K. Leung, Y. Halpern, T. D. Barfoot,
H. H. T. Liu, International Journal of Robotics Research 30(8), 969-974, 2011).
"""
from __future__ import annotations

import os
from typing import NamedTuple, Sequence
import warnings

import numpy

from rbx1_nav.base.kinematics import Pose
from rbx1_nav.base.robot_parameters import Robot
from rbx1_nav.base.units import SECOND, Array
from rbx1_nav.node.config import ConfigError, show_name

LARGEST = 1e10      # s, m, ...: largest number allowed in a run
MIN_TRAVEL, MIN_TURN = 0.02, 0.1    # m, rad: thresholds for motion
CAMERAS = 0.001, 0.001, 0.003   # m, m, rad: 1 sigma of a motion capture system, from stationary robots
COMMANDS, TRUTH = '_Odometry.dat', '_Groundtruth.dat'   # suffixes of file names


class Commands(NamedTuple):
    """Velocity commands, each of which is in force until the next."""

    time: Array     # s
    linear: Array   # m/s forward
    angular: Array  # rad/s to the left


class Track(NamedTuple):
    """A series of poses."""

    time: Array     # s
    x: Array        # m
    y: Array        # m
    yaw: Array      # rad, not wrapped


class Rates(NamedTuple):
    """The readings of a gyro."""

    time: Array     # s
    rate: Array     # rad/s


class Recording(NamedTuple):
    """A recorded run."""

    name: str       # for messages
    commands: Commands
    odometry: Track | None      # wheel odometry
    gyro: Rates | None
    truth: Track | None
    end: Pose | None    # end pose measured by hand, in the frame of the first pose


def check_series(name: str, series: Commands | Track | Rates) -> None:
    """Raise ConfigError unless all values of a Commands, Track or Rates are finite, and its stamps never decrease.

    name: name of the series in messages, including its file.
    """
    for field, values in zip(series._fields, series):
        bad = numpy.flatnonzero(numpy.nan_to_num(abs(values), nan=LARGEST) >= LARGEST)
        if bad.size:
            raise ConfigError(f'{name}: {field} of message {bad[0] + 1}: {values[bad[0]]}: expected a finite number '
                              'below 1e10')
    back = numpy.flatnonzero(numpy.diff(series.time) < 0)
    if back.size:
        before, after = series.time[back[0]:back[0] + 2]
        raise ConfigError(f'{name}: stamp of message {back[0] + 2}: {before - after:.3f} s before message '
                          f'{back[0] + 1}: expected stamps that never decrease')


def check_recording(recording: Recording) -> Recording:
    """Return a Recording that has commands, motion, and valid series on one clock. Raises ConfigError for any other."""
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
            raise ConfigError(f'{name}: {field} from {series.time[0]:.1f} to {series.time[-1]:.1f} s, but commands '
                              f'from {commands.time[0]:.1f} to {commands.time[-1]:.1f} s: expected the same time span, '
                              'on one clock')
        if field != 'gyro' and not (max(numpy.ptp(series.x), numpy.ptp(series.y)) > MIN_TRAVEL
                                    or numpy.ptp(series.yaw) > MIN_TURN):
            raise ConfigError(f'{name}: {field}: the robot did not move, although it was commanded to: expected the '
                              'topic of the robot that was driven')
    return recording


def check_end(recording: Recording) -> Recording:
    """Return a Recording whose odometry lasts until the robot stops, if its end pose was measured by hand. Raises
    ConfigError for any other. The commands are those in_force()."""
    time, linear, angular = recording.commands
    moving = numpy.flatnonzero((linear != 0) | (angular != 0))[-1]
    stop = numpy.append(time, numpy.inf)[moving + 1]    # inf: without a timeout, the robot drives on
    if recording.end and recording.odometry and recording.odometry.time[-1] < stop:
        raise ConfigError(f'{recording.name}: odometry until {recording.odometry.time[-1]:.1f} s, but the robot drives '
                          f'until {stop:.1f} s: expected odometry until the robot is at the measured end pose')
    return recording


def in_force(commands: Commands, robot: Robot) -> Commands:
    """Return the Commands as a base executes them: within the limits of a Robot, and until they time out."""
    time, linear, angular = commands
    linear = numpy.clip(linear, -robot.limits.linear, robot.limits.linear)
    angular = numpy.clip(angular, -robot.limits.angular, robot.limits.angular)
    timeout = robot.timeout / SECOND
    if timeout:
        late = numpy.flatnonzero(numpy.diff(time, append=numpy.inf) > timeout)
        time = numpy.insert(time, late + 1, time[late] + timeout)
        linear = numpy.insert(linear, late + 1, 0.0)
        angular = numpy.insert(angular, late + 1, 0.0)
    return Commands(time, linear, angular)


def relative(pose: Array | Sequence[float] | Sequence[Array],
             other: Array | Sequence[float] | Sequence[Array]) -> Array:
    """Return the pose `other` (x, y in m, yaw in rad) in the frame of `pose` as an array; each may be many poses."""
    x, y = other[0] - pose[0], other[1] - pose[1]
    c, s = numpy.cos(pose[2]), numpy.sin(pose[2])
    return numpy.array([c * x + s * y, c * y - s * x, other[2] - pose[2]])


def is_commands_file(path: str) -> bool:
    """Return whether a file contains the commands of a robot, according to its name."""
    return path.endswith(COMMANDS)


def truth_file(path: str) -> str:
    """Return the path of the truth file that belongs to the commands file `path`."""
    return path[:-len(COMMANDS)] + TRUTH


def read_table(path: str) -> Array:
    """Return the columns of a text file of numbers. Raises ConfigError."""
    try:
        with warnings.catch_warnings():
            warnings.simplefilter('ignore', UserWarning)    # a file without numbers: its columns are counted below
            table = numpy.loadtxt(path, ndmin=2)
    except (OSError, ValueError, UnicodeDecodeError) as error:
        raise ConfigError(f'{show_name(path)}: expected a text file of numbers: '
                          f"{' '.join(str(error).split())}") from error
    return table.T


def read_robot(commands: str, truth: str) -> Recording:
    """Read a Recording from two files. Raises ConfigError.

    NAME_Odometry.dat contains time (s) and commanded m/s and rad/s; NAME_Groundtruth.dat contains time (s), x and y
    (m), and heading (rad).
    """
    tables = []
    for path, width in ((commands, 3), (truth, 4)):
        table = read_table(path)
        if len(table) != width:
            raise ConfigError(f'{show_name(path)}: {len(table) if table.size else 0} columns: expected {width}')
        tables.append(table)
    name = os.path.basename(commands).replace(COMMANDS, '')
    track = Track(*tables[1])
    recording = check_recording(Recording(name, Commands(*tables[0]), None, None, track, None))
    return recording._replace(truth=track._replace(yaw=numpy.unwrap(track.yaw)))
