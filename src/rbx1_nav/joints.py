"""A position-controlled joint, as simply as the ArbotiX driver simulates its servos."""
from math import isfinite

from rbx1_nav.base import RefusedCommand, clamp


class Joint:
    """Moves towards its goal at its highest speed, and stays within its limits. Radians and seconds."""

    def __init__(self, name, lower, upper, max_speed):
        """lower, upper: limits, rad; max_speed: rad/s."""
        self.name = name
        self.lower = lower
        self.upper = upper
        self.max_speed = max_speed
        self.position = self.goal = min(max(0.0, lower), upper)
        self.velocity = 0.0

    def command(self, goal):
        """Set the goal (rad), moved to the nearer limit where it lies outside. Raises RefusedCommand if not finite."""
        if not isfinite(goal):
            raise RefusedCommand('%s: expected a finite angle in rad' % goal)
        self.goal = min(max(goal, self.lower), self.upper)

    def advance(self, duration):
        """Move for `duration` seconds."""
        way = clamp(self.goal - self.position, self.max_speed * duration)
        self.velocity = way / duration if duration > 0 else 0.0
        # land on the goal itself, not a rounding error beside it
        self.position = self.goal if way == self.goal - self.position else self.position + way
