"""Checks and limits each velocity command before it reaches a base, simulated or real."""
from __future__ import annotations

from math import inf
from typing import Sequence

from rbx1_nav.base.robot_parameters import Limits
from rbx1_nav.base.units import clamp

MAX_COMMAND = 1e6   # m/s or rad/s: far above any robot, and far below where sums overflow


class RejectedCommand(ValueError):
    """Raised for a command that no base should follow.

    The text gives the value and what is expected.
    """


class RefusedCommand(ValueError):
    """Raised for a command that the robot does not follow at present.

    The text gives the reason.
    """


class CommandGate:
    """Holds the command in force: finite, within the limits, and no older than the timeout."""

    def __init__(self, limits: Limits, timeout: int) -> None:
        """timeout: ns; 0 for no timeout."""
        self.limits = limits
        self.timeout = timeout
        self.linear = 0.0       # m/s, in force
        self.angular = 0.0      # rad/s, in force
        self.moving = False     # whether the command in force moves the robot
        self.command_time: int | None = None    # ns, arrival of the last command
        self.expiry: float = inf        # ns, when the command in force times out; infinite without a timeout
        self.rejected = 0
        self.clamped = 0

    def command(self, now: int, linear: float, angular: float, others: Sequence[float] = ()) -> bool:
        """Put a command in force at `now` (ns), and return whether a limit clamped it.

        linear: m/s forward; angular: rad/s to the left; others: velocities that a differential drive cannot follow, but
        which must also be finite. Raises RejectedCommand, and halts, if a value is not finite or above MAX_COMMAND.
        """
        self.command_time = now
        self.expiry = now + self.timeout if self.timeout else inf
        if linear == self.linear and angular == self.angular and not any(others):    # repeated: checked before
            return False
        for value in (linear, angular, *others):
            if not abs(value) <= MAX_COMMAND:   # written so that nan is rejected too
                self.rejected += 1
                self.halt()
                raise RejectedCommand(f'{value}: expected finite numbers of at most {MAX_COMMAND:g}')
        self.linear = clamp(linear, self.limits.linear)
        self.angular = clamp(angular, self.limits.angular)
        self.moving = bool(self.linear or self.angular)
        clamped = (self.linear, self.angular) != (linear, angular)
        if clamped:
            self.clamped += 1
        return clamped

    def halt(self) -> None:
        """Stop the motion until the next command."""
        self.linear = self.angular = 0.0
        self.moving = False

    def forget(self) -> None:
        """Halt, and discard the arrival time of the last command: for a clock that jumped back."""
        self.halt()
        self.command_time, self.expiry = None, inf
