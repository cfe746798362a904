"""A position-controlled joint, modeled as simply as the servos in the ArbotiX driver's simulation."""
from __future__ import annotations

from math import isfinite
from typing import Sequence

from rbx1_nav.units import SECOND, clamp


class Joint:
    """A joint that moves toward its goal at its maximum speed and stays within its limits.

    Radians and seconds.
    """

    def __init__(self, name: str, lower: float, upper: float, max_speed: float) -> None:
        """lower, upper: limits, rad; max_speed: rad/s."""
        self.name = name
        self.lower = lower
        self.upper = upper
        self.max_speed = max_speed
        self.position = self.goal = min(max(0.0, lower), upper)
        self.velocity = 0.0

    def command(self, goal: float) -> None:
        """Set the goal (rad), limited to the joint's range. Raises ValueError if it is not finite."""
        if not isfinite(goal):
            raise ValueError(f'{goal}: expected a finite angle in rad')
        self.goal = min(max(goal, self.lower), self.upper)

    def advance(self, duration: float) -> None:
        """Move for `duration` seconds."""
        step = clamp(self.goal - self.position, self.max_speed * duration)
        self.velocity = step / duration if duration > 0 else 0.0
        # stop exactly at the goal, without a rounding error
        self.position = self.goal if step == self.goal - self.position else self.position + step


class JointGroup:
    """Advances several joints on one clock, in ns."""

    def __init__(self, joints: Sequence[Joint]) -> None:
        self.joints = joints
        self.now: int | None = None

    def advance(self, now: int) -> None:
        """Advance the joints to `now`. If the clock jumped back, no joint moves."""
        elapsed = max(0, now - self.now) if self.now is not None else 0
        self.now = now
        for joint in self.joints:
            joint.advance(elapsed / SECOND)
