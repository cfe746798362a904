"""Whether wheels and gyro agree as well as their floor lets them, over the last turns of the robot."""
from math import copysign, exp, sqrt

TURN = 0.2          # rad: the parts in which a turn is looked at
TURN_TIMEOUT = 5.0      # s: a robot that has not turned that far by then goes straight, or stands
MEMORY = 10.0       # rad: a turn is forgotten with the exponential of what the robot has turned since
LEAST = 1.5         # rad: less says too little
DEVIATIONS = 5.0    # standard deviations that are no chance any more
AGREE = 2.0         # standard deviations within which a part shows that they agree again
ROUNDING = 0.005    # rad: what wheels and gyro may differ by anyway


def floor_variance(prior, turned, travelled):
    """The variance (rad^2) of the difference of wheels and gyro in a turn (rad, at least 0) and along a path (m) on the
    floor of these Priors."""
    return (ROUNDING ** 2 + (prior.slip_turning_spread ** 2 + prior.gyro_scale_error ** 2) * turned ** 2
            + prior.heading_noise_turning ** 2 * turned + prior.heading_noise_straight ** 2 * travelled)


class Agreement:
    """Sums of what wheels and gyro measured in turns, each counted in its own direction."""

    def __init__(self):
        # since the last whole part: wheels and gyro (rad, counter-clockwise positive), variance of the gyro, m, s
        self.part = [0.0] * 5
        self.last = None        # the last whole part
        self.wheels = self.gyro = self.turned = 0.0     # rad; turned: by the one that reports more
        self.variance = self.travelled = self.time = 0.0    # rad^2, m, s
        self.scatter = 0.0      # rad^2: squares of what the differences deviate from a constant fraction of the turn

    def add(self, wheels, gyro, variance, travelled, duration):
        """A step: the turn (rad) by the wheels, and by the gyro without its bias, with its variance; m by the wheels;
        s. Returns whether that makes a part, so that there is something new to ask for."""
        part = self.part
        part[0] += wheels
        part[1] += gyro
        part[2] += variance
        part[3] += travelled
        part[4] += duration
        if abs(part[0]) < TURN and abs(part[1]) < TURN:
            if part[4] > TURN_TIMEOUT:
                self.part = [0.0] * 5
            return False
        # in its direction by the wheels, unless they have hardly turned
        sign = copysign(1, part[0] if abs(part[0]) > TURN / 2 else part[1])
        lead = max(abs(part[0]), abs(part[1]))
        kept = exp(-lead / MEMORY)
        self.wheels = self.wheels * kept + sign * part[0]
        self.gyro = self.gyro * kept + sign * part[1]
        self.turned = self.turned * kept + lead
        self.variance = self.variance * kept + part[2]
        self.travelled = self.travelled * kept + part[3]
        self.time = self.time * kept + part[4]
        deviation = sign * (part[0] - part[1]) - (self.wheels - self.gyro) * lead / self.turned
        self.scatter = self.scatter * kept + deviation ** 2
        self.last = self.part
        self.part = [0.0] * 5
        return True

    def ratio(self, bias):
        """By what fraction of the turn wheels and gyro differ (root mean square of the value and its standard error);
        None if the turn was too short. bias: variance of the gyro's bias, rad^2/s^2."""
        if self.turned <= LEAST:
            return None
        return sqrt((self.wheels - self.gyro) ** 2 + self.scatter + bias * self.time ** 2) / self.turned

    def difference(self, prior, bias):
        """The angle (rad) by which wheels and gyro differ more than on a floor; 0 if that may be chance.

        prior: the Priors of the floor; bias: variance of the gyro's bias, rad^2/s^2.
        """
        difference = self.wheels * (1 - prior.slip_turning) - self.gyro
        variance = self.variance + bias * self.time ** 2 + floor_variance(prior, self.turned, self.travelled)
        return difference if self.turned > LEAST and abs(difference) > DEVIATIONS * sqrt(variance) else 0.0

    def agrees(self, prior):
        """Whether wheels and gyro differ no more in the last part than on the floor of these Priors."""
        wheels, gyro, variance, travelled, _ = self.last
        difference = wheels * (1 - prior.slip_turning) - gyro
        return difference ** 2 < AGREE ** 2 * (variance + floor_variance(prior, abs(wheels), travelled))
