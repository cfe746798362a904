"""The base: one gate for commands, the wheels behind it, and the odometry that counts their travel.

Times are whole nanoseconds on a clock that the caller chooses, so that twenty milliseconds are twenty milliseconds.
"""
from collections import namedtuple
from math import copysign

from rbx1_nav.diff_drive import ORIGIN, Odometry

SECOND = 10 ** 9
MOST = 1e6      # m/s or rad/s that a command may ask for: no robot does, and sums stay far from overflow

Limits = namedtuple('Limits', 'linear angular')
Limits.__doc__ = 'Highest speeds that the gate lets through, m/s and rad/s; infinite where there is no limit.'


class RefusedCommand(ValueError):
    """A command that no base should follow."""


def clamp(value, limit):
    """value, or the limit with its sign where it is over it."""
    return copysign(min(abs(value), limit), value)


class Base:
    """A differential-drive base on a clock of its own.

    A command is in force from the moment it arrives until the next one arrives, or until it is `timeout` old. The pose
    is the exact integral over those intervals, whenever it is asked for.
    """

    def __init__(self, wheels, limits, timeout):
        """wheels: see wheels.py; timeout: how long a command stays in force, ns; 0 for ever."""
        self.wheels = wheels
        self.odometry = Odometry(wheels.base_width)
        self.limits = limits
        self.timeout = timeout
        self.linear = 0.0       # m/s, in force
        self.angular = 0.0      # rad/s, in force
        self.left = 0.0         # m, counted travel of the left wheel since the start
        self.right = 0.0        # m
        self.now = 0            # ns, how far the motion is integrated
        self.command_time = None    # ns, arrival of the last command, None before the first
        self.refused = 0
        self.clamped = 0

    @property
    def moving(self):
        """Whether the command in force is to move."""
        return self.linear != 0 or self.angular != 0

    @property
    def velocity(self):
        """The speeds that the wheels tell, m/s and rad/s."""
        return self.wheels.velocity(self.linear, self.angular)

    @property
    def true_velocity(self):
        """The speeds of the robot itself, m/s and rad/s."""
        return self.wheels.true_velocity(self.linear, self.angular)

    @property
    def standing(self):
        """Whether nothing moves and nothing is to move."""
        return not self.moving and self.wheels.at_rest

    def command(self, now, linear, angular, others=()):
        """Put a command in force: m/s forward and rad/s to the left, from `now` (ns) on.

        others: velocities that a differential drive cannot follow; they need only be finite.
        Returns True where a limit cut it. Raises RefusedCommand, and stops the base, where it is not finite or over MOST.
        """
        self.advance(now)
        self.command_time = self.now
        for value in (linear, angular, *others):
            if not abs(value) <= MOST:      # so that nan is refused too
                self.refused += 1
                self.halt()
                raise RefusedCommand('%s: expected finite numbers of at most %g' % (value, MOST))
        self.linear = clamp(linear, self.limits.linear)
        self.angular = clamp(angular, self.limits.angular)
        cut = (self.linear, self.angular) != (linear, angular)
        self.clamped += cut
        return cut

    def halt(self):
        """No motion until the next command."""
        self.linear = self.angular = 0.0

    def advance(self, now):
        """Integrate the motion up to `now` (ns). Returns True where the timeout stopped the base on the way.

        A clock that jumped back forgets the command in force: how long it has been so cannot be known any more.
        """
        timed_out = False
        if now < self.now:
            self.halt()
            self.command_time = None
        elif self.moving:
            end = self.command_time + self.timeout if self.timeout else now + 1     # later than now: never
            self._move(min(now, end) - self.now)
            if now >= end:
                self.halt()
                timed_out = True
                self._roll_out(now - end)
        else:
            self._roll_out(now - self.now)
        self.now = now
        return timed_out

    def reset(self):
        """Stand still at the origin."""
        self.halt()
        self.wheels.reset()
        self.odometry.pose = ORIGIN

    def _roll_out(self, duration):
        if not self.wheels.at_rest:
            self._move(duration)

    def _move(self, duration):
        left, right = self.wheels.travel(self.linear, self.angular, duration / SECOND)
        self.left += left
        self.right += right
        self.odometry.update(left, right)
