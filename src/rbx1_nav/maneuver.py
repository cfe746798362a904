"""What a robot is to do, as a list of motions: which velocity, and for how many ticks, or until the pose says stop."""
from collections import namedtuple
from math import cos, isfinite, pi, remainder, sin, sqrt

Motion = namedtuple('Motion', 'name linear angular ticks')
Motion.__doc__ = 'One motion: linear in m/s, angular in rad/s (positive to the left), for a number of ticks.'


def ticks(goal, speed, rate):
    """Number of ticks, at `rate` per second, to cover `goal` (m or rad) at `speed` (m/s or rad/s), cut to a whole one.

    Raises ValueError where that is less than one tick, or more than a day.
    """
    number = goal / speed * rate
    if not (isfinite(number) and 1 <= number + 1e-9 <= 24 * 3600 * rate):
        raise ValueError('goal %g / speed %g * rate %g = %g ticks: expected between 1 tick and a day of them'
                         % (goal, speed, rate, number))
    # 0.3 / 0.1 is a little less than 3 to a computer: do not lose a tick to that
    return int(number + 1e-9)


def out_and_back(linear_speed, goal_distance, angular_speed, goal_angle, rate):
    """The tutorial's exercise: forward and turn left, twice, as four Motions. Raises ValueError, see ticks()."""
    try:
        forward = Motion('forward', linear_speed, 0.0, ticks(goal_distance, linear_speed, rate))
    except ValueError as error:
        raise ValueError('goal_distance, linear_speed: %s' % error)
    try:
        turn = Motion('turn left', 0.0, angular_speed, ticks(goal_angle, angular_speed, rate))
    except ValueError as error:
        raise ValueError('goal_angle, angular_speed: %s' % error)
    return [forward, turn, forward, turn]


SLOW_DOWN = 0.5     # s: this time's travel before the goal, a motion begins to slow down
STUCK = 5.0         # s without getting nearer: something holds the robot, or turns it the wrong way


class StuckError(ValueError):
    """A motion that gets no nearer to its goal."""


class Leg:
    """One motion that ends where the pose says so: slower and slower, so that it can stop on its goal."""

    def __init__(self, name, goal, speed, slowest, rate):
        """goal: m or rad; speed, slowest: m/s or rad/s; rate: how often it is asked, Hz. Raises ValueError, see ticks()."""
        self.name = name
        self.goal = goal
        self.speed = speed
        self.slowest = min(slowest, speed)
        self.rate = rate
        self.start = self.last = None   # Pose
        self.turned = 0.0       # rad
        self.nearest = goal     # m or rad
        self.most_patience = max(2, int(STUCK * rate))      # ticks
        self.patience = self.most_patience      # ticks left
        try:
            ticks(goal, self.slowest, rate)
        except ValueError as error:
            raise ValueError('%s: at its slowest, %s' % (self.keys, error))

    def next_speed(self, pose):
        """The speed for the next tick, now that the robot is at `pose`; 0 at the goal. Raises StuckError."""
        if self.start is None:
            self.start = self.last = pose
        self.turned += remainder(pose.yaw - self.last.yaw, 2 * pi)
        self.last = pose
        to_go = self.goal - self.done()
        # nearer than half of the slowest tick's travel it does not get
        if to_go < self.slowest / self.rate / 2:
            return 0.0
        self.patience -= 1
        if to_go < self.nearest - self.slowest / self.rate:
            self.nearest = to_go
            self.patience = self.most_patience
        if self.patience < 0:
            raise StuckError('%s: no nearer for %g s, %.3f of %.3f to go' % (self.name, STUCK, to_go, self.goal))
        # the nearer, the slower: but no faster than it can brake, and never past the goal in one tick or two
        slower = min(to_go / max(SLOW_DOWN, 2 / self.rate), sqrt(2 * self.deceleration * to_go))
        return min(self.speed, max(self.slowest, slower))


class Straight(Leg):
    """Forward, in m and m/s."""

    unit = 'm'
    keys = 'goal_distance, min_linear_speed'
    deceleration = 0.4      # m/s^2, of a robot that need not hurry

    def done(self):
        """How far ahead it went; backwards would be less than nothing."""
        return ((self.last.x - self.start.x) * cos(self.start.yaw) + (self.last.y - self.start.y) * sin(self.start.yaw))

    @staticmethod
    def velocity(speed):
        """(linear, angular) for a speed."""
        return speed, 0.0


class Turn(Leg):
    """To the left on the spot, in rad and rad/s."""

    unit = 'rad'
    keys = 'goal_angle, min_angular_speed'
    deceleration = 2.0      # rad/s^2

    def done(self):
        """How far it turned."""
        return self.turned

    @staticmethod
    def velocity(speed):
        """(linear, angular) for a speed."""
        return 0.0, speed


def out_and_back_by_odometry(linear_speed, goal_distance, angular_speed, goal_angle, rate, min_linear_speed,
                             min_angular_speed):
    """The same exercise as four Legs that ask where the robot is: m/s, m, rad/s, rad, Hz, m/s and rad/s.

    Raises ValueError, see ticks().
    """
    return [leg for _ in range(2)
            for leg in (Straight('forward', goal_distance, linear_speed, min_linear_speed, rate),
                        Turn('turn left', goal_angle, angular_speed, min_angular_speed, rate))]
