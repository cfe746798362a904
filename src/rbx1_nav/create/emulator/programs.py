"""The robot's own programs: cleaning, docking and the demos of the Create, in which the robot drives by itself.

A motion is a function of the time in s since the program started. It returns a velocity in mm/s and a radius in mm, as
in the command Drive, or None when the program has finished.
"""
from math import pi, sqrt

from rbx1_nav.create.protocol import IN_PLACE_LEFT, STRAIGHT
from rbx1_nav.units import SECOND

SPEED = 200             # mm/s
INNER_RADIUS = 150      # mm, of a spiral where it starts
PITCH = 150             # mm between two turns of a spiral: less than the robot is wide
SPIRAL_TIME = 24.0      # s, in which a spiral reaches a radius of 0.5 m
EIGHT_RADIUS = 300      # mm
CIRCLE_TIME = 2 * pi * EIGHT_RADIUS / SPEED     # s
LEG_TIME, TURN_TIME = 4.5, 1.5      # s; a turn of more than 90 degrees
ABORT = 255             # -1, the number of a demo that stops the one that is running (Create p. 8)

FORWARD, TURN, STILL = (SPEED, STRAIGHT[0]), (SPEED, IN_PLACE_LEFT), (0, STRAIGHT[0])


def spiral(time):
    """Outward; the distance between two turns is constant."""
    return SPEED, sqrt(INNER_RADIUS ** 2 + PITCH * SPEED * time / pi)


def spot(time):
    """A spiral outward, then inward (Create p. 8)."""
    return spiral(min(time, 2 * SPIRAL_TIME - time)) if time < 2 * SPIRAL_TIME else None


def search(time):
    """Straight legs, with a turn after each."""
    return FORWARD if time % (LEG_TIME + TURN_TIME) < LEG_TIME else TURN


def cover(time):
    """A spiral, then straight legs."""
    return spiral(time) if time < SPIRAL_TIME else search(time - SPIRAL_TIME)


def figure_eight(time):
    """A circle to the left, then one to the right."""
    return SPEED, EIGHT_RADIUS if time % (2 * CIRCLE_TIME) < CIRCLE_TIME else -EIGHT_RADIUS


def forward(_):
    """In search of a wall, which is not there."""
    return FORWARD


def spin(_):
    """In search of a virtual wall, which is not there."""
    return TURN


def still(_):
    """Waiting for somebody to push the robot, or to touch its sensors."""
    return STILL


# by number: cover, cover and dock, spot cover, mouse, figure eight, wimp, home, tag, Pachelbel, banjo (Create p. 8)
DEMOS = (cover, search, spot, forward, figure_eight, still, spin, spin, still, still)


class Programs:
    """The program that is running, if any. do_...() are commands, and get their data bytes."""

    def __init__(self, body):
        """body: a Body."""
        self.body = body
        self.started = 0        # programs since the robot was made
        self._motion = None
        self._start = None      # ns, the first update of the program

    @property
    def running(self):
        """Whether a program is running."""
        return self._motion is not None

    def stop(self):
        """Stop the program that is running, and with it the robot."""
        if self.running:
            self._motion = None
            self.body.drive(0, 0)

    def update(self, now):
        """To be called every 15 ms while a program is running: the velocity and the radius to drive with now."""
        if self._start is None:
            self._start = now
        motion = self._motion((now - self._start) / SECOND)
        body = self.body
        if motion is None or body.wheel_dropped or body.cliff or body.docked:
            self.stop()
            return STILL
        return TURN if body.bumped and motion != STILL else motion

    def do_spot(self, _):
        """Clean a spot."""
        self._start_or_pause(spot)

    def do_cover(self, _):
        """Clean a room."""
        self._start_or_pause(cover)

    def do_max(self, _):
        """Clean a room until the battery is empty."""
        self._start_or_pause(cover)

    def do_dock(self, _):
        """Search for the dock."""
        self._start_or_pause(search)

    def do_demo(self, data):
        """Start a demo in place of the program that is running, or stop that program."""
        if data[0] == ABORT:
            self.stop()
        elif data[0] < len(DEMOS):
            self._begin(DEMOS[data[0]])

    def _start_or_pause(self, motion):
        """As with the robot's buttons: while a program is running, each of them pauses it (Create 2 p. 11-12)."""
        if self.running:
            self.stop()
        else:
            self._begin(motion)

    def _begin(self, motion):
        self.started += 1
        self._motion, self._start = motion, None
