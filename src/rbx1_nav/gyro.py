"""A gyro about the vertical axis: what it reads of a robot's heading, and what can be made of the readings.

Radians and seconds; counter-clockwise positive.
"""
from collections import namedtuple
import random

from rbx1_nav.base import clamp
from rbx1_nav.wheels import LEAST_VARIANCE, MEASURED

NOISE_RATE = 50.0   # Hz, at which the surface's file gives the noise: it grows with the root of the rate, as white noise does

Reading = namedtuple('Reading', 'rate rate_variance yaw yaw_variance')
Reading.__doc__ = """What a gyro tells: angular velocity as read (rad/s), its noise (rad^2/s^2); the heading that the
calibrated readings add up to (rad, not wrapped), and how well that is known (rad^2)."""


class IdealGyro:
    """Tells the truth."""

    def __init__(self):
        self.yaw = 0.0

    def read(self, yaw, duration, standing):        # pylint: disable=unused-argument
        """See Gyro.read."""
        rate = (yaw - self.yaw) / duration
        self.yaw = yaw
        return Reading(rate, MEASURED, yaw, MEASURED)

    def reset(self):
        """Start again with a robot at the origin."""
        self.yaw = 0.0


class Gyro:
    """A gyro with bias, scale error, noise, and an end of its range.

    As long as the robot stands before its first motion, it calibrates itself, as the TurtleBot's driver does: the mean of
    those readings is taken off before they are added up to a heading. The angular velocity that it tells is as read.
    """

    def __init__(self, surface, run, seed):
        """surface: a Surface; run: the Run drawn from it; seed: of the noise."""
        self.surface = surface
        self.run = run
        self.noise = random.Random('gyro %d' % seed).gauss
        self.reset()

    def read(self, yaw, duration, standing):
        """A Reading, `duration` (s, above 0) after the one before; the robot's true heading is now `yaw` (rad).

        The rate is the mean over that time, as of a gyro that samples faster than it is read. standing: whether the
        wheels have stood meanwhile.
        """
        surface = self.surface
        noise = surface.gyro_noise / (NOISE_RATE * duration) ** 0.5
        rate = (yaw - self._true_yaw) / duration * (1 + self.run.gyro_scale_error) + self.run.gyro_bias
        rate = clamp(rate + self.noise(0.0, noise), surface.gyro_measurement_range)
        self._true_yaw = yaw
        if standing and self._calibrating:
            self._rest += duration
            self._rest_angle += rate * duration
        else:
            self._calibrating = False
            self._time += duration
            offset = self._rest_angle / self._rest if self._rest else 0.0
            self._yaw += (rate - offset) * duration
            self._turned += abs(rate - offset) * duration
        density = surface.gyro_noise ** 2 / NOISE_RATE      # rad^2/s: of the angle, for each second of readings
        bias = min(density / self._rest, surface.gyro_bias ** 2) if self._rest else surface.gyro_bias ** 2
        variance = (MEASURED + density * self._time + bias * self._time ** 2
                    + (surface.gyro_scale_error * self._turned) ** 2)
        return Reading(rate, max(noise ** 2, LEAST_VARIANCE), self._yaw, variance)

    def reset(self):
        """Start again with a robot at the origin, with bias and scale error as they are."""
        self._true_yaw = self._yaw = self._turned = self._time = 0.0
        self._rest = self._rest_angle = 0.0     # s, and rad of readings, of the calibration
        self._calibrating = True
