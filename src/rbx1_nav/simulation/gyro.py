"""A gyro about the vertical axis: its readings, and the heading that is integrated from them.

Radians and seconds; counter-clockwise positive.
"""
from __future__ import annotations

import random
from typing import Union

from rbx1_nav.base.covariances import MEASURED, MIN_VARIANCE, Reading
from rbx1_nav.base.surfaces import Surface
from rbx1_nav.base.units import clamp
from rbx1_nav.simulation.slip import RandomErrors

NOISE_RATE = 50.0   # Hz, the rate that gyro_noise refers to: white noise grows with the square root of the rate


class IdealGyro:
    """A gyro without errors."""

    def __init__(self) -> None:
        self.yaw = 0.0

    def read(self, yaw: float, duration: float, _at_rest: bool) -> Reading:
        """Return a Reading, `duration` (s, above 0) after the previous one.

        yaw: the robot's true heading now, rad. The rate of the Reading is the mean over this time, as from a gyro that
        samples faster than it is read.
        """
        rate = (yaw - self.yaw) / duration
        self.yaw = yaw
        return Reading(rate, MEASURED, yaw, MEASURED)

    def reset(self) -> None:
        """Restart with the robot at the origin."""
        self.yaw = 0.0


class Gyro:
    """A gyro with bias, scale error, noise and a limited range.

    While the robot is stationary before its first motion, the gyro is calibrated as in the TurtleBot's driver: the mean
    of these readings is subtracted from later readings before they are integrated into a heading. The reported angular
    velocity is uncalibrated.
    """

    def __init__(self, surface: Surface, run: RandomErrors, seed: int) -> None:
        """run: the errors drawn from the surface; seed: seed of the noise."""
        self.surface = surface
        self.run = run
        self.noise = random.Random(f'gyro {seed}').gauss
        self.density = surface.gyro_noise ** 2 / NOISE_RATE     # rad^2/s: variance of the angle per second of readings
        self.reset()

    def reset(self) -> None:
        """Restart with the robot at the origin. Bias and scale error do not change."""
        self._true_yaw = self._yaw = 0.0
        self._turned = self._time = 0.0         # rad, both directions counted positive, and s since the calibration
        self._rest = self._rest_angle = 0.0     # duration (s) and summed readings (rad) of the calibration
        self._offset, self._offset_variance = 0.0, self.surface.gyro_bias ** 2      # its result, rad/s and rad^2/s^2
        self._calibrating = True

    def read(self, yaw: float, duration: float, at_rest: bool) -> Reading:
        """See IdealGyro. at_rest: whether the wheels were at rest during this time."""
        surface = self.surface
        noise = surface.gyro_noise / (NOISE_RATE * duration) ** 0.5
        rate = (yaw - self._true_yaw) / duration * (1 + self.run.gyro_scale_error) + self.run.gyro_bias
        rate = clamp(rate + self.noise(0.0, noise), surface.gyro_measurement_range)
        self._true_yaw = yaw
        if at_rest and self._calibrating:
            self._rest += duration
            self._rest_angle += rate * duration
            self._offset = self._rest_angle / self._rest
            self._offset_variance = min(self.density / self._rest, surface.gyro_bias ** 2)
        else:
            self._calibrating = False
            turn = (rate - self._offset) * duration
            self._yaw += turn
            self._turned += abs(turn)
            self._time += duration
        variance = (MEASURED + self.density * self._time + self._offset_variance * self._time ** 2
                    + (surface.gyro_scale_error * self._turned) ** 2)
        return Reading(rate, max(noise ** 2, MIN_VARIANCE), self._yaw, variance)


AnyGyro = Union[IdealGyro, Gyro]
