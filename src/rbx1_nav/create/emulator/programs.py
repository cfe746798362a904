"""The robot's own programs: cleaning, docking and the demos of the Create, in which the robot drives by itself.

A motion is a function of the time in s since the program started. It returns a velocity in mm/s and a radius in mm, as
in the Drive command, or None when the program has finished.
"""
from __future__ import annotations

from math import pi, sqrt
from typing import Callable, Optional, Tuple

from rbx1_nav.create.emulator.body import Body
from rbx1_nav.create.protocol import IN_PLACE_LEFT, STRAIGHT
from rbx1_nav.units import SECOND

SPEED = 200             # mm/s
INNER_RADIUS = 150      # mm, initial radius of a spiral
PITCH = 150             # mm between two turns of a spiral: less than the width of the robot
SPIRAL_TIME = 24.0      # s in which a spiral reaches a radius of 0.5 m
EIGHT_RADIUS = 300      # mm
CIRCLE_TIME = 2 * pi * EIGHT_RADIUS / SPEED     # s
LEG_TIME, TURN_TIME = 4.5, 1.5      # s; a turn of more than 90 degrees
ABORT = 255             # -1, the demo number that stops the running demo (Create p. 8)

Curve = Tuple[float, float]     # mm/s, mm
Course = Callable[[float], Optional[Curve]]

FORWARD, TURN, STILL = (SPEED, STRAIGHT[0]), (SPEED, IN_PLACE_LEFT), (0, STRAIGHT[0])


def spiral(time: float) -> Curve:
    """Spiral outward, with a constant distance between two turns."""
    return SPEED, sqrt(INNER_RADIUS ** 2 + PITCH * SPEED * time / pi)


def spot(time: float) -> Curve | None:
    """Spiral outward, then inward (Create p. 8)."""
    return spiral(min(time, 2 * SPIRAL_TIME - time)) if time < 2 * SPIRAL_TIME else None


def search(time: float) -> Curve:
    """Drive straight legs, with a turn after each."""
    return FORWARD if time % (LEG_TIME + TURN_TIME) < LEG_TIME else TURN


def cover(time: float) -> Curve:
    """Drive a spiral, then straight legs."""
    return spiral(time) if time < SPIRAL_TIME else search(time - SPIRAL_TIME)


def figure_eight(time: float) -> Curve:
    """Drive a circle to the left, then one to the right."""
    return SPEED, EIGHT_RADIUS if time % (2 * CIRCLE_TIME) < CIRCLE_TIME else -EIGHT_RADIUS


def forward(_: float) -> Curve:
    """Drive in search of a wall, which does not exist here."""
    return FORWARD


def spin(_: float) -> Curve:
    """Spin in search of a virtual wall, which does not exist here."""
    return TURN


def still(_: float) -> Curve:
    """Wait for a push, or a touch of the sensors."""
    return STILL


# by number: cover, cover and dock, spot cover, mouse, figure eight, wimp, home, tag, Pachelbel, banjo (Create p. 8)
DEMOS: Tuple[Course, ...] = (cover, search, spot, forward, figure_eight, still, spin, spin, still, still)


class Programs:
    """The running program, if any. The do_...() methods execute commands, whose data bytes they receive."""

    def __init__(self, body: Body) -> None:
        self.body = body
        self.started = 0        # number of programs started so far
        self._motion: Course | None = None
        self._start: int | None = None      # ns, time of the first update of the program

    @property
    def running(self) -> bool:
        """Whether a program is running."""
        return self._motion is not None

    def stop(self) -> None:
        """Stop the running program and the robot."""
        if self.running:
            self._motion = None
            self.body.drive(0, 0)

    def update(self, now: int) -> Curve:
        """Return the current velocity and radius. Call it every 15 ms while a program is running."""
        if self._start is None:
            self._start = now
        motion = self._motion((now - self._start) / SECOND) if self._motion else None
        body = self.body
        if motion is None or body.wheel_dropped or body.cliff or body.docked:
            self.stop()
            return STILL
        return TURN if body.bumped and motion != STILL else motion

    def do_spot(self, _: bytes) -> None:
        """Clean a spot."""
        self._start_or_pause(spot)

    def do_cover(self, _: bytes) -> None:
        """Clean a room."""
        self._start_or_pause(cover)

    def do_max(self, _: bytes) -> None:
        """Clean a room until the battery is empty."""
        self._start_or_pause(cover)

    def do_dock(self, _: bytes) -> None:
        """Search for the dock."""
        self._start_or_pause(search)

    def do_demo(self, data: bytes) -> None:
        """Start a demo instead of the running program, or stop that program."""
        if data[0] == ABORT:
            self.stop()
        elif data[0] < len(DEMOS):
            self._begin(DEMOS[data[0]])

    def _start_or_pause(self, motion: Course) -> None:
        """Act like the robot's buttons, each of which pauses a running program (Create 2 p. 11-12)."""
        if self.running:
            self.stop()
        else:
            self._begin(motion)

    def _begin(self, motion: Course) -> None:
        self.started += 1
        self._motion, self._start = motion, None
