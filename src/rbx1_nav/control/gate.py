"""The gate that every velocity command passes on its way to a base, simulated or real."""
from __future__ import annotations

from math import inf
from typing import Iterable

from rbx1_nav.robot.description import Limits
from rbx1_nav.units import clamp

MAX_COMMAND = 1e6   # m/s or rad/s: far above any robot, and far below where sums overflow


class RejectedCommand(ValueError):
    """A command that no base should follow. The text gives the value and what is expected."""


class RefusedCommand(ValueError):
    """A command that the robot does not follow now. The text says why."""


class CommandGate:
    """Holds the command in force: finite, within the limits, and no older than the timeout."""

    def __init__(self, limits: Limits, timeout: int) -> None:
        """timeout: ns, 0 for none."""
        self.limits = limits
        self.timeout = timeout
        self.linear = 0.0       # m/s, in force
        self.angular = 0.0      # rad/s, in force
        self.command_time: int | None = None    # ns, arrival of the last command
        self.rejected = 0
        self.clamped = 0

    @property
    def moving(self) -> bool:
        """Whether the command in force is a motion."""
        return self.linear != 0 or self.angular != 0

    @property
    def expiry(self) -> float:
        """When the command in force times out, ns; infinite without a timeout."""
        return self.command_time + self.timeout if self.timeout and self.command_time is not None else inf

    def command(self, now: int, linear: float, angular: float, others: Iterable[float] = ()) -> bool:
        """Put a command in force at `now` (ns): m/s forward and rad/s to the left. Returns whether a limit clamped it.

        others: velocities that a differential drive cannot follow; they must be finite all the same. Raises
        RejectedCommand, and halts, if a value is not finite or above MAX_COMMAND.
        """
        self.command_time = now
        for value in (linear, angular, *others):
            if not abs(value) <= MAX_COMMAND:   # written so that nan is rejected too
                self.rejected += 1
                self.halt()
                raise RejectedCommand(f'{value}: expected finite numbers of at most {MAX_COMMAND:g}')
        self.linear = clamp(linear, self.limits.linear)
        self.angular = clamp(angular, self.limits.angular)
        clamped = (self.linear, self.angular) != (linear, angular)
        if clamped:
            self.clamped += 1
        return clamped

    def halt(self) -> None:
        """No motion until the next command."""
        self.linear = self.angular = 0.0

    def forget(self) -> None:
        """Halt, and forget when the last command arrived: for a clock that jumped back."""
        self.halt()
        self.command_time = None
