"""Learns the noise of the wheels and the drift of the gyro from measurements."""
from __future__ import annotations

from math import sqrt

FIRST_COUNT = 5.0   # number of differences of the expected size that are assumed before the first real one
GREATEST = 9.0      # square of a difference / its variance: larger values are limited to this


class NoiseFactor:
    """Noise of the wheels, as a fraction (at most 1) of the assumed variance.

    It is learned from the squares of the differences of wheels and gyro, relative to their expected values (covariance
    matching: Mehra, Approaches to Adaptive Filtering, IEEE Transactions on Automatic Control 17, 1972).
    """

    def __init__(self) -> None:
        self.mean, self.count = 1.0, FIRST_COUNT
        self.value = 1.0

    def add(self, square: float, share: float) -> None:
        """Add a difference.

        square: square of the difference, divided by its variance; share: fraction of this variance that is noise of the
        wheels.
        """
        self.count += share ** 2
        # toward the factor for which the square has its expected size
        self.mean *= 1 + share * (min(square, GREATEST) - 1) / self.count
        # cautious at first, by 2 sigma: the relative variance of a mean of squares of normal numbers is 2 / count
        self.value = min(1.0, self.mean * (1 + 2 * sqrt(2 / self.count)))


class Drift:
    """Variance (rad^2/s^4) of the rate at which the gyro's bias changes between two standstills, by least squares.

    Only the part that exceeds the noise by 1 sigma counts.
    """

    def __init__(self) -> None:
        self.num = self.den = self.noise = self.value = 0.0

    def add(self, time: float, square: float, noise: float) -> None:
        """Add a change of the bias.

        time: s since the bias was last known; square: square of the change, rad^2/s^2; noise: expected square without a
        drift.
        """
        weight = time ** 2
        self.num += weight * (square - noise)
        self.den += weight ** 2
        self.noise += 2 * (weight * noise) ** 2     # the variance of the square of a normal number is 2
        self.value = max(0.0, self.num - sqrt(self.noise)) / self.den
