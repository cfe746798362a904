"""One recorded run, ready to be fitted: the travel of its wheels, and the parts of its path whose end is known."""
from __future__ import annotations

import numpy

from rbx1_nav.fitting.floor import Windows
from rbx1_nav.fitting.recording import Recording, relative
from rbx1_nav.fitting.travel import Steps, commanded_travel, grid, reported_travel
from rbx1_nav.simulation.surfaces import Surface
from rbx1_nav.units import wrap_angle

MAX_GAP = 0.25      # s: a window in which the truth is unknown for so long is left out
ROLL_OUT = 3.0      # s after the last command, until the end was measured by hand
MOTORS = ('delay', 'lag', 'accel_limit', 'drag_straight', 'drag_turning')


class PreparedRun:
    """A Recording with its time cut into steps. Times are in s."""

    def __init__(self, recording: Recording, base_width: float, start: float | None = None,
                 end: float | None = None) -> None:
        """base_width: m; start, end: of the part that counts; default: all that was recorded of commands, odometry and
        truth alike."""
        self.recording = recording
        self.base_width = base_width
        series = [each.time for each in (recording.odometry or recording.commands, recording.truth) if each]
        first, last = max(time[0] for time in series), min(time[-1] for time in series)
        if recording.end and not recording.odometry:
            last += ROLL_OUT    # the end is where the robot came to rest
        self.times = grid(max(first, first if start is None else start), min(last, last if end is None else end))
        self._steps: dict[tuple[float, ...] | None, Steps] = {}

    def steps(self, surface: Surface) -> Steps:
        """The Steps: as odometry reports them, else as commanded on a Surface."""
        key = None if self.recording.odometry else tuple(getattr(surface, each) for each in MOTORS)
        if key not in self._steps:
            if len(self._steps) > 4:        # a fit needs the last few
                self._steps.pop(next(iter(self._steps)))
            self._steps[key] = (reported_travel(self.recording.odometry, self.times) if self.recording.odometry else
                                commanded_travel(surface, self.base_width, self.recording.commands, self.times))
        return self._steps[key]

    def windows(self, length: float, stride: float | None = None) -> Windows:
        """The Windows of a length in s, which begin `stride` (default: the length) apart, without gaps of the truth.
        """
        count = round(length / (self.times[1] - self.times[0]))
        apart = count if stride is None else round(stride / (self.times[1] - self.times[0]))
        truth = self.recording.truth
        assert truth
        x, y, yaw = (numpy.interp(self.times, truth.time, values) for values in truth[1:])
        after = numpy.clip(numpy.searchsorted(truth.time, self.times), 1, len(truth.time) - 1)
        gap = truth.time[after] - truth.time[after - 1] > MAX_GAP
        first = numpy.arange(0, len(self.times) - count, apart)
        before = numpy.append(0, numpy.cumsum(gap))     # times with a gap before each
        first = first[before[first + count + 1] == before[first]]
        start, end = ((x[index], y[index], yaw[index]) for index in (first, first + count))
        return Windows(first, count, relative(start, end).T)

    def whole(self, yaw: float) -> Windows:
        """The Windows, one, of a run whose end was measured by hand; yaw: as predicted, rad: it has the number of full
        turns."""
        assert self.recording.end
        x, y, measured = self.recording.end
        return Windows(numpy.array([0]), len(self.times) - 1, numpy.array([[x, y, yaw + wrap_angle(measured - yaw)]]))
