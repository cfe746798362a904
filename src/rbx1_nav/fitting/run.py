"""One recorded run prepared for a fit: the travel of its wheels, and the parts of its path with a known end pose."""
from __future__ import annotations

import numpy

from rbx1_nav.fitting.floor import Windows
from rbx1_nav.fitting.recording import Recording, relative
from rbx1_nav.fitting.travel import Steps, commanded_travel, grid, reported_travel
from rbx1_nav.simulation.surfaces import Surface
from rbx1_nav.units import wrap_angle

MAX_GAP = 0.25      # s: windows with a longer gap in the truth are excluded
ROLL_OUT = 3.0      # s to include after the last command if the end pose was measured by hand
MOTORS = ('delay', 'lag', 'accel_limit', 'drag_straight', 'drag_turning')


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
        count = round(length / (self.times[1] - self.times[0]))
        apart = count if stride is None else round(stride / (self.times[1] - self.times[0]))
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
