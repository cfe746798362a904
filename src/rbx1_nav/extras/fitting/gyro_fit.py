"""Fits the errors of a gyro: its bias and noise at rest, and its scale from the true heading."""
from __future__ import annotations

from typing import Sequence

import numpy
from scipy.stats import chi2, norm

from rbx1_nav.base.kinematics import Pose
from rbx1_nav.base.units import Array, NDArray
from rbx1_nav.extras.fitting.recording import Rates, Recording, Track
from rbx1_nav.simulation.gyro import NOISE_RATE

SETTLED = 1.5       # s after a stop command after which a robot counts as stationary
INTERVAL = 1.0      # s: turns in intervals of this length are compared
MIN_TURN = 3.0      # rad: minimum turn for fitting the scale


def rests_at(recording: Recording, times: Array, delay: float = 0.0) -> NDArray[numpy.bool_]:
    """Return whether the robot was stationary at each of `times` (s): no command to move for SETTLED plus `delay` (s).
    """
    commands = recording.commands
    moving = (commands.linear != 0) | (commands.angular != 0)
    before = numpy.searchsorted(commands.time, times, side='right') - 1
    # the latest time, up to each command, at which the robot was commanded to move
    ends = numpy.append(commands.time[1:], numpy.inf)
    last = numpy.maximum.accumulate(numpy.where(moving, ends, -numpy.inf))
    latest = numpy.where(before >= 0, last[before], -numpy.inf)
    return times > latest + SETTLED + delay


def rest_of(recording: Recording, gyro: Rates, delay: float) -> tuple[float, float, int] | None:
    """Return (bias in rad/s, noise at NOISE_RATE in rad/s, number of readings) of the gyro while the robot was
    stationary; None if there are too few readings."""
    time, rate = gyro
    at_rest = rests_at(recording, time, delay)
    period = numpy.median(numpy.diff(time)) if len(time) > 1 else 0.0
    if at_rest.sum() < 20 or not period > 0:
        return None
    readings = rate[at_rest]
    return readings.mean(), readings.std(ddof=1) * (period * NOISE_RATE) ** 0.5, len(readings)


def gyro_turns(gyro: Rates, bias: float, times: Array) -> Array:
    """Return the angles (rad) that the gyro measured between `times` (s). A reading is the mean since the previous one.
    """
    time, rate = gyro
    angle = numpy.append(0.0, numpy.cumsum((rate[1:] - bias) * numpy.diff(time)))
    return numpy.diff(numpy.interp(times, time, angle))


def scale_by_truth(gyro: Rates, truth: Track, bias: float, noise: float) -> tuple[float, float] | None:
    """Return (scale error, its standard error) from a continuous truth; None if the robot turns too little.

    bias, noise: of the gyro, rad/s.
    """
    time = gyro.time
    first, last = max(truth.time[0], time[0]), min(truth.time[-1], time[-1])
    times = first + INTERVAL * numpy.arange(max(0, int((last - first) / INTERVAL)) + 1)
    if len(times) < 3:
        return None
    turned = numpy.diff(numpy.interp(times, truth.time, truth.yaw))
    measured = gyro_turns(gyro, bias, times)
    if abs(turned).sum() < MIN_TURN:
        return None
    scale = (turned @ measured) / (turned @ turned)
    left = ((measured - scale * turned) ** 2).sum() / (len(times) - 2)
    floor = noise ** 2 / NOISE_RATE * INTERVAL
    return scale - 1, (max(left, floor) / (turned @ turned)) ** 0.5


def scale_by_end(gyro: Rates, end: Pose, bias: float, noise: float,
                 heading_error: float) -> tuple[float, float] | None:
    """Return (scale error, its standard error) from an end pose measured by hand; None if the run turns too little.

    bias, noise: of the gyro, rad/s; heading_error: 1 sigma of the measured heading, rad.
    """
    time = gyro.time
    turned = gyro_turns(gyro, bias, time[[0, -1]])[0]
    if abs(turned) < MIN_TURN:
        return None
    true = turned + (end.yaw - turned + numpy.pi) % (2 * numpy.pi) - numpy.pi
    error = numpy.hypot(heading_error, noise * ((time[-1] - time[0]) / NOISE_RATE) ** 0.5)
    return turned / true - 1, abs(error / turned)


def root_mean_square(values: Sequence[float], errors: Sequence[float]) -> tuple[float, float]:
    """Return (rms of the true values, its standard error) for values that were measured with errors."""
    variance = (numpy.asarray(values) ** 2).mean()
    of_errors = (numpy.asarray(errors) ** 2).mean()
    own = max(variance - of_errors, 0.0)
    # the true variance may be larger by this factor, with the probability of one standard error; it is rarely smaller
    largest = variance * len(values) / chi2.ppf(norm.cdf(-1), len(values))
    return own ** 0.5, max(largest - of_errors, 0.0) ** 0.5 - own ** 0.5


def fit_gyro(recordings: Sequence[Recording], delay: float = 0.0,
             heading_error: float = 0.0) -> dict[str, tuple[float, float]]:
    """Fit gyro_noise and gyro_bias (rad/s) and gyro_scale_error. Returns {key: (value, standard error)} for the keys
    that the Recordings determine; the standard error is infinite for a single run. delay: of the motors, s;
    heading_error: 1 sigma of end poses measured by hand, rad."""
    found: dict[str, tuple[float, float]] = {}
    biases: list[tuple[float, float]] = []
    scales: list[tuple[float, float]] = []
    noises: list[tuple[float, int]] = []
    for recording in recordings:
        gyro, truth, end = recording.gyro, recording.truth, recording.end
        rest = rest_of(recording, gyro, delay) if gyro else None
        if gyro is None or rest is None:
            continue
        bias, noise, number = rest
        biases.append((bias, noise / number ** 0.5))
        noises.append((noise, number))
        scale = None
        if truth:
            scale = scale_by_truth(gyro, truth, bias, noise)
        elif end:
            scale = scale_by_end(gyro, end, bias, noise, heading_error)
        if scale:
            scales.append(scale)
    if noises:
        values, numbers = numpy.transpose(noises)
        value = ((values ** 2 * (numbers - 1)).sum() / (numbers - 1).sum()) ** 0.5
        found['gyro_noise'] = value, value / (2 * (numbers - 1).sum()) ** 0.5
    for key, some in (('gyro_bias', biases), ('gyro_scale_error', scales)):
        if some:
            value, error = root_mean_square(*zip(*some))
            found[key] = value, (error if len(some) > 1 else numpy.inf)
    return found
