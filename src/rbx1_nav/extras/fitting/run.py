"""One recorded run prepared for a fit: the travel of its wheels in small steps, and the parts of its path whose end
pose is known.
"""
from __future__ import annotations

from copy import copy
from typing import NamedTuple

import numpy

from rbx1_nav.base.surfaces import Surface
from rbx1_nav.base.units import Array, NDArray, wrap_angle
from rbx1_nav.extras.fitting.recording import Commands, Recording, Track, relative
from rbx1_nav.simulation.motors import Motor

STEP = 0.05     # s
MAX_GAP = 0.25      # s: windows with a longer gap in the truth are excluded
ROLL_OUT = 3.0      # s to include after the last command if the end pose was measured by hand
MOTORS = ('delay', 'lag', 'accel_limit', 'drag_straight', 'drag_turning')


class Steps(NamedTuple):
    """The wheel travel in each step."""

    straight: Array     # m
    turn: Array         # rad
    rounded: bool = False   # whether encoders have rounded it to whole ticks


def grid(start: float, end: float) -> Array:
    """Return times from `start` to `end` (s), STEP apart."""
    return start + STEP * numpy.arange(int((end - start) / STEP) + 1)


def commanded_travel(surface: Surface, base_width: float, commands: Commands, times: Array) -> Steps:
    """Return the Steps between `times` (s) of motors on a Surface that were at rest before the first of the Commands.

    base_width: m.
    """
    changes = numpy.flatnonzero(numpy.append(True, numpy.diff(commands.linear) != 0)
                                | numpy.append(True, numpy.diff(commands.angular) != 0))
    starts = commands.time[changes] + surface.delay
    linear, angular = commands.linear[changes], commands.angular[changes] * base_width / 2
    borders = numpy.unique(numpy.concatenate([starts, times]))
    borders = borders[borders <= times[-1]]
    in_force = numpy.searchsorted(starts, borders[:-1], side='right') - 1
    straight = Motor(surface.lag, surface.accel_limit, surface.drag_straight)
    turning = Motor(surface.lag, surface.accel_limit, surface.drag_turning)
    travelled = [(straight.travel(linear[index], duration), turning.travel(angular[index], duration)) if index >= 0
                 else (0.0, 0.0) for index, duration in zip(in_force.tolist(), numpy.diff(borders).tolist())]
    step = numpy.searchsorted(times, borders[:-1], side='right') - 1
    travel = numpy.array(travelled).reshape(-1, 2)[step >= 0].T
    distance, side = numpy.array([numpy.bincount(step[step >= 0], values, len(times) - 1) for values in travel])
    return Steps(distance, 2 * side / base_width)


def reported_travel(odometry: Track, times: Array) -> Steps:
    """Return the Steps between `times` (s) according to the odometry."""
    x, y, yaw = (numpy.interp(times, odometry.time, values) for values in odometry[1:])
    turn = numpy.diff(yaw)
    middle = yaw[:-1] + turn / 2
    chord = numpy.diff(x) * numpy.cos(middle) + numpy.diff(y) * numpy.sin(middle)
    return Steps(chord / numpy.sinc(turn / 2 / numpy.pi), turn, rounded=True)      # the inverse of Odometry.move()


class Windows(NamedTuple):
    """Parts of a recording with measured end poses."""

    first: NDArray[numpy.int_]      # (n,), index of the first step of each window
    length: int     # number of steps in each window
    ends: Array     # (n, 3), end poses in the frame of the start of each window: x, y (m), yaw (rad)


class PreparedRun:
    """A Recording whose time is divided into steps. Times are in s."""

    def __init__(self, recording: Recording, base_width: float, start: float | None = None,
                 end: float | None = None) -> None:
        """base_width: m; start, end: limits of the part to use; default: the time for which the odometry (or, without
        odometry, the commands) and the truth were recorded."""
        self.recording = recording
        self.base_width = base_width
        series = [each.time for each in (recording.odometry or recording.commands, recording.truth) if each]
        first, last = max(time[0] for time in series), min(time[-1] for time in series)
        if recording.end and not recording.odometry:
            last += ROLL_OUT    # the robot coasts to its end pose
        self.times = grid(max(first, first if start is None else start), min(last, last if end is None else end))
        self._steps: dict[tuple[float, ...] | None, Steps] = {}

    def commanded(self) -> PreparedRun:
        """Return this run without its odometry, with the same times."""
        other = copy(self)
        other.recording, other._steps = self.recording._replace(odometry=None), {}
        return other

    def steps(self, surface: Surface) -> Steps:
        """Return the Steps from the odometry, or without odometry from the commands on a Surface."""
        key = None if self.recording.odometry else tuple(getattr(surface, each) for each in MOTORS)
        if key not in self._steps:
            if len(self._steps) > 4:        # a fit needs the last few
                self._steps.pop(next(iter(self._steps)))
            self._steps[key] = (reported_travel(self.recording.odometry, self.times) if self.recording.odometry else
                                commanded_travel(surface, self.base_width, self.recording.commands, self.times))
        return self._steps[key]

    def windows(self, length: float, stride: float | None = None) -> Windows:
        """Return the Windows without gaps in the truth. length: s; stride: s between their starts; default: length."""
        step = float(self.times[1] - self.times[0])     # numpy 1.17 rounds its own floats to floats
        count = round(length / step)
        apart = count if stride is None else round(stride / step)
        truth = self.recording.truth
        assert truth
        x, y, yaw = (numpy.interp(self.times, truth.time, values) for values in truth[1:])
        after = numpy.clip(numpy.searchsorted(truth.time, self.times), 1, len(truth.time) - 1)
        gap = truth.time[after] - truth.time[after - 1] > MAX_GAP
        first = numpy.arange(0, len(self.times) - count, apart)
        before = numpy.append(0, numpy.cumsum(gap))     # number of gaps before each time
        first = first[before[first + count + 1] == before[first]]
        start, end = ((x[index], y[index], yaw[index]) for index in (first, first + count))
        return Windows(first, count, relative(start, end).T)

    def whole(self, yaw: float) -> Windows:
        """Return a single window for a run whose end pose was measured by hand. yaw: predicted yaw in rad, which
        determines the number of full turns."""
        assert self.recording.end
        x, y, measured = self.recording.end
        return Windows(numpy.array([0]), len(self.times) - 1, numpy.array([[x, y, yaw + wrap_angle(measured - yaw)]]))
