"""What the robot does by itself: its programs, which are cleaning, docking and the demos of the Create.

A driver can only see that the robot drives although it was not asked to. So each program drives the same circle.
"""
from __future__ import annotations

from rbx1_nav.extras.create.emulator.body import Body

CIRCLE = (200, 300)     # mm/s, mm: speed and radius
DEMOS = 10              # number of demos (Create p. 8)
ABORT = 255             # -1, the demo number that stops the running demo


class Programs:
    """The running program, if any. The do_...() methods execute commands, whose data bytes they receive."""

    def __init__(self, body: Body) -> None:
        self.body = body
        self.started = 0        # number of programs started so far
        self.running = False

    def stop(self) -> None:
        """Stop the running program and the robot."""
        if self.running:
            self.running = False
            self.body.drive(0, 0)

    def do_spot(self, _: bytes) -> None:
        """Start to clean. Like each of the robot's buttons, this pauses a running program (Create 2 p. 11-12)."""
        if self.running:
            self.stop()
        else:
            self._begin()

    do_cover = do_max = do_dock = do_spot

    def do_demo(self, data: bytes) -> None:
        """Start a demo instead of the running program, or stop that program."""
        if data[0] == ABORT:
            self.stop()
        elif data[0] < DEMOS:
            self._begin()

    def _begin(self) -> None:
        self.started += 1
        self.running = True
