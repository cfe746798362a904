"""Whether wheels and gyro agree as well as their floor lets them, over the last turns of the robot."""
from __future__ import annotations

from dataclasses import dataclass
from math import copysign, exp, sqrt

from rbx1_nav.estimation.priors import Priors

TURN = 0.2          # rad: the parts in which a turn is looked at
TURN_TIMEOUT = 5.0      # s: a robot that has not turned that far by then goes straight, or stands
MEMORY = 10.0       # rad: a turn is forgotten with the exponential of what the robot has turned since
LEAST = 1.5         # rad: less says too little
DEVIATIONS = 5.0    # standard deviations that are no chance any more
AGREE = 2.0         # standard deviations within which a part shows that they agree again
ROUNDING = 0.005    # rad: what wheels and gyro may differ by anyway


def floor_variance(prior: Priors, turned: float, travelled: float) -> float:
    """The variance (rad^2) of the difference of wheels and gyro in a turn (rad, at least 0) and along a path (m) on the
    floor of these Priors."""
    return (ROUNDING ** 2 + (prior.slip_turning_spread ** 2 + prior.gyro_scale_error ** 2) * turned ** 2
            + prior.heading_noise_turning ** 2 * turned + prior.heading_noise_straight ** 2 * travelled)


@dataclass
class Sum:
    """What was measured, added up."""

    wheels: float = 0.0     # rad, counter-clockwise positive
    gyro: float = 0.0       # rad, without its bias
    variance: float = 0.0   # rad^2, of the gyro's turn
    travelled: float = 0.0  # m, by the wheels
    time: float = 0.0       # s


class Agreement:
    """Sums of what wheels and gyro measured in turns, each counted in its own direction."""

    def __init__(self) -> None:
        self.part = Sum()       # since the last whole part
        self.last = Sum()       # the last whole part
        self.wheels = self.gyro = self.turned = 0.0     # rad; turned: by the one that reports more
        self.variance = self.travelled = self.time = 0.0    # rad^2, m, s
        self.scatter = 0.0      # rad^2: squares of what the differences deviate from a constant fraction of the turn

    def add(self, wheels: float, gyro: float, variance: float, travelled: float, duration: float) -> bool:
        """A step: the turn (rad) by the wheels, and by the gyro without its bias, with its variance; m by the wheels;
        s. Returns whether that makes a part, so that there is something new to ask for."""
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
        # in its direction by the wheels, unless they have hardly turned
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
        """By what fraction of the turn wheels and gyro differ (root mean square of the value and its standard error);
        None if the turn was too short. bias: variance of the gyro's bias, rad^2/s^2."""
        if self.turned <= LEAST:
            return None
        return sqrt((self.wheels - self.gyro) ** 2 + self.scatter + bias * self.time ** 2) / self.turned

    def difference(self, prior: Priors, bias: float) -> float:
        """The angle (rad) by which wheels and gyro differ more than on a floor; 0 if that may be chance.

        prior: the Priors of the floor; bias: variance of the gyro's bias, rad^2/s^2.
        """
        difference = self.wheels * (1 - prior.slip_turning) - self.gyro
        variance = self.variance + bias * self.time ** 2 + floor_variance(prior, self.turned, self.travelled)
        return difference if self.turned > LEAST and abs(difference) > DEVIATIONS * sqrt(variance) else 0.0

    def agrees(self, prior: Priors) -> bool:
        """Whether wheels and gyro differ no more in the last part than on the floor of these Priors."""
        last = self.last
        difference = last.wheels * (1 - prior.slip_turning) - last.gyro
        return difference ** 2 < AGREE ** 2 * (last.variance + floor_variance(prior, abs(last.wheels), last.travelled))
