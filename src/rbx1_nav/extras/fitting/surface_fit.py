"""Fits a surface to recordings, with a standard error for each value or a reason why it cannot be determined."""
from __future__ import annotations

from math import degrees
from typing import Callable, NamedTuple, Sequence

import numpy

from rbx1_nav.base.surfaces import KEYS, Surface
from rbx1_nav.extras.fitting.end_poses import TYPICAL, fit_ends, future_spreads
from rbx1_nav.extras.fitting.floor_fit import BOUNDS, MEANS, MIN_STRENGTH, RELATIVE, Fitter, fit_floor, uncertainty
from rbx1_nav.extras.fitting.gyro_fit import fit_gyro, rests_at
from rbx1_nav.extras.fitting.motor_fit import LIMITS, differing, fit_motors
from rbx1_nav.extras.fitting.prediction import SPREADS, with_values
from rbx1_nav.extras.fitting.recording import CAMERAS, Recording
from rbx1_nav.extras.fitting.run import MOTORS, PreparedRun
from rbx1_nav.node.config import ConfigError
from rbx1_nav.simulation.floor_noise import NOISES

FLOOR = ('slip_straight', 'slip_turning', 'curvature', 'turning_loss')
RESOLUTION = 0.0003, 0.0003, 0.001  # m, m, rad: resolution of encoders, the smallest error of an end pose
SHORTEST, LONGEST = 2.0, 10.0       # s: limits of the length of a window
WINDOWS = 100       # number of windows in the total time, within these limits
WIDEST = 10.0       # largest ratio of the error of an end pose in motion to the error of the truth at rest
CLEARLY_WIDER = 2.0
MIN_RUNS = 3        # number of runs required for a spread from run to run
LARGEST = {'accel_limit': 0.3, 'lag': 0.1, 'gyro_noise': 0.02, 'gyro_bias': 0.02, 'gyro_scale_error': 0.01,
           **{key: error for key, (_, error) in MEANS.items()}, **dict.fromkeys(NOISES, 0.05)}  # see uncertainty()
LARGEST_SPREAD = 1.5    # largest error of a spread, in units of the spread; a larger one comes from the prior
POOR = 0.1          # fraction of the travel, rms, that the motor model may leave unexplained; but always at least
POOR_TRAVEL = 0.002     # m


class Value(NamedTuple):
    """A value of a surface, in SI units."""

    key: str
    value: float
    error: float | None     # 1 sigma; None for a value that was not fitted
    reason: str | None      # why it was not fitted


class FitResult(NamedTuple):
    surface: Surface
    values: list[Value]     # one per key, in the order of a file
    warnings: list[str]
    description: str        # one line: what was fitted, and to which data
    notes: list[str]


class WholeFit:
    """Fits all parts of a surface."""

    def __init__(self, recordings: Sequence[Recording], base_width: float, start: Surface,
                 end_errors: tuple[float, float, float] | None = None) -> None:
        """recordings: with equal series, see check_alike(); base_width: m; end_errors: 1 sigma of end poses measured by
        hand: x, y (m), yaw (rad). Raises ConfigError."""
        check_alike(recordings)
        self.recordings = recordings
        self.base_width = base_width
        self.start = self.surface = start
        self.end_errors = end_errors
        self.errors: dict[str, float] = {}
        self.reasons: dict[str, str] = {}
        self.warnings: list[str] = []
        self.notes: list[str] = []
        self.description = 'motors and gyro'
        self.has_odometry = recordings[0].odometry is not None

    def run(self, progress: Callable[[str], object] = lambda part: None) -> FitResult:
        """Fit all parts. progress(part): called with the name of each part before it is fitted. Raises ConfigError."""
        recordings = self.recordings
        if self.has_odometry:
            progress('motors')
            self._fit_motors()
        progress('floor')
        if recordings[0].truth:
            self._fit_to_truth()
        elif recordings[0].end:
            self._fit_to_ends()
        elif not self.has_odometry:
            raise ConfigError(f'{recordings[0].name}: neither odometry nor truth: expected at least one of them')
        progress('gyro')
        self._fit_gyro()
        values = [Value(key, getattr(self.surface, key), self.errors.get(key),
                        None if key in self.errors else self.reasons.get(key, 'not determined by these runs'))
                  for key in KEYS]
        return FitResult(self.surface, values, self.warnings, self.description, self.notes)

    def _set(self, key: str, value: float, error: float, bounds: tuple[float, float] | None = None) -> bool:
        """Accept a fitted value unless its standard error is too large. Returns whether it was accepted."""
        low, high = bounds or KEYS[key].limits
        if not doubt(key, value, error) <= 1:
            self.reasons[key] = f'found {value:.3g} +- {error:.2g}: too uncertain'
            return False
        if bounds and (value <= low * 1.001 + 1e-9 or value >= high * 0.999) and low != 0:
            self.warnings.append(f'{key}: {value:.4g}: at the limit of its range')
        self.surface = with_values(self.surface, {key: float(numpy.clip(value, *KEYS[key].limits))})
        self.errors[key] = float(error)
        self.reasons.pop(key, None)
        return True

    def _stopping_time(self) -> float:
        """Return the time (s) after which the motors have almost reached a commanded speed."""
        return self.surface.delay + 5 * self.surface.lag

    def _fit_motors(self) -> None:
        fit = fit_motors(self.start, self.base_width, self.recordings)
        self.warnings += differing(fit, self.start, self.base_width, self.recordings)
        for key in MOTORS:
            if key not in fit.unused:
                self._set(key, fit.values[key], fit.errors[key], LIMITS[key])
            else:
                self.reasons[key] = 'no measurable effect in these runs'
        if 'accel_limit' not in self.errors:    # never reached, so it must not take effect on the new surface either
            limit = max(self.start.accel_limit, fit.values['accel_limit'])
            self.surface = self.surface._replace(accel_limit=limit)
            self.reasons['accel_limit'] = 'not reached in these runs: at least about their highest acceleration'
        if fit.rms > max(POOR_TRAVEL, POOR * fit.travel):
            self.warnings.append(f'odometry: of {1e3 * fit.travel:.1f} mm rms in 0.2 s, commands and motors do not '
                                 f'explain {1e3 * fit.rms:.1f} mm: check that the commands and the odometry belong to '
                                 'the same robot')

    def _fit_to_truth(self) -> None:
        runs = [PreparedRun(recording, self.base_width) for recording in self.recordings]
        total = sum(run.times[-1] - run.times[0] for run in runs)
        length = float(numpy.clip(total / WINDOWS, SHORTEST, LONGEST))
        windows = [run.windows(length) for run in runs]
        number = sum(len(each.first) for each in windows)
        if not number:
            raise ConfigError(f'truth: no window of {length:.1f} s without a gap in {len(runs)} recordings: expected '
                              'at least one')
        runs = [run for run, each in zip(runs, windows) if len(each.first)]
        windows = [each for each in windows if len(each.first)]
        self.description = (f"floor, from {'odometry' if self.has_odometry else 'commands'} and the truth in {number} "
                            f'windows of {length:.1f} s')
        means = FLOOR if self.has_odometry else ('delay', 'lag') + FLOOR
        if not self.has_odometry:
            for key in ('accel_limit', 'drag_straight', 'drag_turning'):
                self.reasons[key] = 'no odometry'
            self.notes.append('Without odometry, the fit cannot distinguish drag from slip: these slips are valid with '
                              'the drags of the starting surface.')
        noises = NOISES + (SPREADS if len(runs) >= MIN_RUNS else ())
        for key in SPREADS if len(runs) < MIN_RUNS else ():
            self.reasons[key] = f'{len(runs)} of at least {MIN_RUNS} runs'
        fitter = Fitter(runs, windows, truth_errors(self.recordings, self._stopping_time()),
                        by_cells=True, widest=WIDEST)
        start = with_values(self.surface, {key: getattr(self.surface, key) or TYPICAL[key] for key in noises})
        if 'delay' in means:
            start = start._replace(delay=self.surface.delay or 0.1)
        surface, errors = self._fit_known(fitter, start, means, noises)
        fitted = [key for key in SPREADS if key in errors]
        if fitted:
            spreads, found = future_spreads(surface, errors, len(runs) - 1), surface
            surface = with_values(surface, {key: spreads[key] for key in fitted})
            errors.update((key, errors[key] * spreads[key] / getattr(found, key)) for key in fitted)
            self.notes.append(', '.join(f'{key}: found {getattr(found, key):.2g}' for key in fitted) + '. The file has '
                              f'larger spreads, because {len(runs)} runs are few: they contain the standard errors of '
                              'the slips and of the spreads, and the 90 % region should contain 90 % of the end poses '
                              "of future runs (Student's t distribution).")
        for key, error in errors.items():
            self._set(key, getattr(surface, key), error, BOUNDS.get(key))
        if fitter.wider > CLEARLY_WIDER:
            x, y, yaw = numpy.sqrt(numpy.diag(fitter.floor))
            self.notes.append(f'The end poses of the windows have additional errors of {1e3 * max(x, y):.1f} mm and '
                              f'{degrees(yaw):.2f} degrees, which do not grow along the path: errors of the truth, or '
                              'of the times of the commands. They are not in the surface.')

    def _fit_known(self, fitter: Fitter, start: Surface, means: Sequence[str],
                   noises: Sequence[str]) -> tuple[Surface, dict[str, float]]:
        """Fit the keys that the runs determine. Returns (Surface, {key: standard error}). The other keys keep their
        current values."""
        prior = start
        # rounding to whole ticks looks like turns in the odometry, but not in the commands
        commanded = Fitter([run.commanded() for run in fitter.runs], fitter.windows, RESOLUTION, fitter.by_cells)
        while True:
            surface, errors = fit_floor(fitter, start, means, noises, prior)
            commanded.measured, commanded.wider = fitter.measured, fitter.wider
            by_commands = commanded.mean_errors(surface, means)
            unsure = {key: doubt(key, getattr(surface, key), max(errors[key], by_commands.get(key, 0.0)))
                      for key in (*means, *noises)}
            # drop the worst first: without it, the others may be determined
            worst = max(unsure, key=lambda key: unsure[key])
            if unsure[worst] <= 1:
                break
            self.reasons[worst] = f'found {getattr(surface, worst):.3g} +- {errors[worst]:.2g}: too uncertain'
            if doubt(worst, getattr(surface, worst), errors[worst]) <= 1:
                self.reasons[worst] = 'without effect on the end poses of these commands'
            start = with_values(surface, {worst: getattr(self.surface, worst)})
            means, noises = ([key for key in keys if key != worst] for keys in (means, noises))
            if not means and not noises:
                return start, {}
        for key in noises:
            if getattr(surface, key) < 2 * MIN_STRENGTH:
                surface = with_values(surface, {key: 0.0})
        return surface, errors

    def _fit_to_ends(self) -> None:
        assert self.end_errors
        runs = [PreparedRun(recording, self.base_width) for recording in self.recordings]
        self.description = (f"floor, from {'odometry' if self.has_odometry else 'commands'} and {len(runs)} end poses "
                            'measured by hand')
        fit = fit_ends(runs, self.surface, self.end_errors)
        self.surface = with_values(self.surface, fit.values)
        self.errors.update(fit.errors)
        self.reasons.update(fit.reasons)
        self.notes += fit.notes

    def _fit_gyro(self) -> None:
        found = fit_gyro(self.recordings, self._stopping_time(),
                         self.end_errors[2] if self.end_errors else 0.0)
        for key in ('gyro_noise', 'gyro_bias', 'gyro_scale_error', 'gyro_measurement_range'):
            self.reasons[key] = 'not determined by these runs' if self.recordings[0].gyro else 'no gyro'
        for key, (value, error) in found.items():
            if error == numpy.inf and len(self.recordings) == 1:
                self.reasons[key] = 'one run only'
            elif not error < value:
                self.reasons[key] = f'found {value:.2g}: smaller than its uncertainty'
            else:
                self._set(key, value, error)


def doubt(key: str, value: float, error: float) -> float:
    """Return the uncertainty() of the value of a key."""
    return uncertainty(value, error, LARGEST.get(key, 0.0), LARGEST_SPREAD if key in SPREADS else RELATIVE)


def check_alike(recordings: Sequence[Recording]) -> None:
    """Raise ConfigError unless all Recordings contain the same series, ignoring gyros."""
    for field in ('odometry', 'truth', 'end'):
        having = [recording for recording in recordings if getattr(recording, field) is not None]
        if 0 < len(having) < len(recordings):
            without = next(each for each in recordings if getattr(each, field) is None)
            raise ConfigError(f'{without.name}: no {field}, although {having[0].name} has it: expected the same data '
                              'in all runs')


def truth_errors(recordings: Sequence[Recording], delay: float) -> tuple[float, ...]:
    """Return 1 sigma of x, y (m) and yaw (rad) of the truth, from stationary robots; at least RESOLUTION.

    delay: of the motors, s.
    """
    squares, number = numpy.zeros(3), 0
    for recording in recordings:
        truth = recording.truth
        assert truth
        still = rests_at(recording, truth.time, delay)
        borders = numpy.flatnonzero(numpy.diff(still.astype(int))) + 1
        for part in numpy.split(numpy.arange(len(still)), borders):
            if len(part) >= 20 and still[part[0]]:
                squares += [numpy.var(values[part]) * len(part) for values in truth[1:]]
                number += len(part)
    return tuple(numpy.hypot(RESOLUTION, (squares / number) ** 0.5)) if number else CAMERAS
