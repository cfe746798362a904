"""Checks whether wheels and gyro have agreed over the robot's last turns as well as the floor allows."""
from __future__ import annotations

from dataclasses import dataclass
from math import copysign, exp, sqrt

from rbx1_nav.estimation.priors import Priors

TURN = 0.2          # rad: size of the parts into which turns are divided
TURN_TIMEOUT = 5.0      # s: a robot that has not turned that far in this time drives straight, or is stationary
MEMORY = 10.0       # rad: the weight of a turn decays exponentially with the turn made since then
LEAST = 1.5         # rad: a smaller turn is not enough evidence
DEVIATIONS = 5.0    # standard deviations beyond which a difference is not due to chance
AGREE = 2.0         # standard deviations within which a part shows that wheels and gyro agree again
ROUNDING = 0.005    # rad: difference of wheels and gyro that is always allowed


def floor_variance(prior: Priors, turned: float, travelled: float) -> float:
    """Return the variance (rad^2) of the difference of wheels and gyro on the floor of these Priors.

    turned: size of the turn, rad, at least 0; travelled: length of the path, m.
    """
    return (ROUNDING ** 2 + (prior.slip_turning_spread ** 2 + prior.gyro_scale_error ** 2) * turned ** 2
            + prior.heading_noise_turning ** 2 * turned + prior.heading_noise_straight ** 2 * travelled)


@dataclass
class Sum:
    """Sums of measurements."""

    wheels: float = 0.0     # rad, counter-clockwise positive
    gyro: float = 0.0       # rad, without its bias
    variance: float = 0.0   # rad^2, variance of the gyro's turn
    travelled: float = 0.0  # m, measured by the wheels
    time: float = 0.0       # s


class Agreement:
    """Sums of the turns that wheels and gyro measured, each counted in its own direction."""

    def __init__(self) -> None:
        self.part = Sum()       # since the last complete part
        self.last = Sum()       # the last complete part
        self.wheels = self.gyro = self.turned = 0.0     # rad; turned: from the sensor that reports more
        self.variance = self.travelled = self.time = 0.0    # rad^2, m, s
        self.scatter = 0.0      # rad^2: squared deviations of the differences from a constant fraction of the turn

    def add(self, wheels: float, gyro: float, variance: float, travelled: float, duration: float) -> bool:
        """Add a step, and return whether it completes a part, so that there are new results.

        wheels: turn measured by the wheels, rad; gyro, variance: turn measured by the gyro, without its bias, rad and
        rad^2; travelled: distance measured by the wheels, m; duration: s.
        """
        part = self.part
        part.wheels += wheels
        part.gyro += gyro
        part.variance += variance
        part.travelled += travelled
        part.time += duration
        if abs(part.wheels) < TURN and abs(part.gyro) < TURN:
            if part.time > TURN_TIMEOUT:
                self.part = Sum()
            return False
        # the direction comes from the wheels, unless they have hardly turned
        sign = copysign(1, part.wheels if abs(part.wheels) > TURN / 2 else part.gyro)
        lead = max(abs(part.wheels), abs(part.gyro))
        kept = exp(-lead / MEMORY)
        self.wheels = self.wheels * kept + sign * part.wheels
        self.gyro = self.gyro * kept + sign * part.gyro
        self.turned = self.turned * kept + lead
        self.variance = self.variance * kept + part.variance
        self.travelled = self.travelled * kept + part.travelled
        self.time = self.time * kept + part.time
        deviation = sign * (part.wheels - part.gyro) - (self.wheels - self.gyro) * lead / self.turned
        self.scatter = self.scatter * kept + deviation ** 2
        self.last, self.part = part, Sum()
        return True

    def ratio(self, bias: float) -> float | None:
        """Return the fraction of the turn by which wheels and gyro differ, or None if the turn was too short.

        The fraction is the root mean square of the value and its standard error. bias: variance of the gyro's bias,
        rad^2/s^2.
        """
        if self.turned <= LEAST:
            return None
        return sqrt((self.wheels - self.gyro) ** 2 + self.scatter + bias * self.time ** 2) / self.turned

    def difference(self, prior: Priors, bias: float) -> float:
        """Return the angle (rad) by which wheels and gyro differ, or 0 if the floor or chance may explain it.

        prior: the Priors of the floor; bias: variance of the gyro's bias, rad^2/s^2.
        """
        difference = self.wheels * (1 - prior.slip_turning) - self.gyro
        variance = self.variance + bias * self.time ** 2 + floor_variance(prior, self.turned, self.travelled)
        return difference if self.turned > LEAST and abs(difference) > DEVIATIONS * sqrt(variance) else 0.0

    def agrees(self, prior: Priors) -> bool:
        """Return whether wheels and gyro differ in the last part by no more than the floor of these Priors explains."""
        last = self.last
        difference = last.wheels * (1 - prior.slip_turning) - last.gyro
        return difference ** 2 < AGREE ** 2 * (last.variance + floor_variance(prior, abs(last.wheels), last.travelled))
