"""A gyro about the vertical axis: its readings, and the heading that they add up to.

Radians and seconds; counter-clockwise positive.
"""
from __future__ import annotations

import random
from typing import Protocol

from rbx1_nav.robot.readings import MEASURED, MIN_VARIANCE, Reading
from rbx1_nav.simulation.surfaces import RandomErrors, Surface
from rbx1_nav.units import clamp

NOISE_RATE = 50.0   # Hz, the rate that gyro_noise refers to: white noise grows with the root of the rate


class AnyGyro(Protocol):
    """What all gyros have."""

    def read(self, yaw: float, duration: float, at_rest: bool) -> Reading:
        """A Reading, `duration` (s, above 0) after the previous one; the robot's true heading is now `yaw` (rad).

        The rate is the mean over that time, as of a gyro that samples faster than it is read. at_rest: whether the
        wheels stood still meanwhile.
        """

    def reset(self) -> None:
        """Start again with a robot at the origin."""


class IdealGyro:
    """A gyro without errors."""

    def __init__(self) -> None:
        self.yaw = 0.0

    def read(self, yaw: float, duration: float, _at_rest: bool) -> Reading:
        rate = (yaw - self.yaw) / duration
        self.yaw = yaw
        return Reading(rate, MEASURED, yaw, MEASURED)

    def reset(self) -> None:
        self.yaw = 0.0


class Gyro:
    """A gyro with bias, scale error, noise and a limited range.

    While the robot stands before its first motion, the gyro is calibrated as by the TurtleBot's driver: the mean of
    those readings is subtracted before later ones are integrated to a heading. The angular velocity is reported
    uncalibrated.
    """

    _true_yaw: float
    _yaw: float
    _turned: float          # rad, both directions counted positive
    _time: float            # s since the calibration
    _rest: float            # s, of the calibration
    _rest_angle: float      # rad, of the readings in this time
    _calibrating: bool

    def __init__(self, surface: Surface, run: RandomErrors, seed: int) -> None:
        """run: the errors drawn from the surface; seed: of the noise."""
        self.surface = surface
        self.run = run
        self.noise = random.Random(f'gyro {seed}').gauss
        self.reset()

    def read(self, yaw: float, duration: float, at_rest: bool) -> Reading:
        surface = self.surface
        noise = surface.gyro_noise / (NOISE_RATE * duration) ** 0.5
        rate = (yaw - self._true_yaw) / duration * (1 + self.run.gyro_scale_error) + self.run.gyro_bias
        rate = clamp(rate + self.noise(0.0, noise), surface.gyro_measurement_range)
        self._true_yaw = yaw
        if at_rest and self._calibrating:
            self._rest += duration
            self._rest_angle += rate * duration
        else:
            self._calibrating = False
            self._time += duration
            offset = self._rest_angle / self._rest if self._rest else 0.0
            self._yaw += (rate - offset) * duration
            self._turned += abs(rate - offset) * duration
        density = surface.gyro_noise ** 2 / NOISE_RATE      # rad^2/s: variance of the angle per second of readings
        bias = min(density / self._rest, surface.gyro_bias ** 2) if self._rest else surface.gyro_bias ** 2
        variance = (MEASURED + density * self._time + bias * self._time ** 2
                    + (surface.gyro_scale_error * self._turned) ** 2)
        return Reading(rate, max(noise ** 2, MIN_VARIANCE), self._yaw, variance)

    def reset(self) -> None:
        """Start again with a robot at the origin. Bias and scale error stay as they are."""
        self._true_yaw = self._yaw = self._turned = self._time = 0.0
        self._rest = self._rest_angle = 0.0     # duration (s) and summed readings (rad) of the calibration
        self._calibrating = True
