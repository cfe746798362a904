"""A simulated run that is recorded as the frames which the page of the web view draws."""
from __future__ import annotations

from math import inf
import sys

from rbx1_nav.base.robot_parameters import Robot
from rbx1_nav.base.surfaces import Surface
from rbx1_nav.base.units import SECOND
from rbx1_nav.extras.many_runs.simulated_run import CALIBRATION, Simulation
from rbx1_nav.extras.web.state import PageState, PoseAndSpeed

INFO, WARNING, ERROR = 2, 4, 8     # levels of rosgraph_msgs/Log
BEGIN = round(CALIBRATION * SECOND)     # ns: frames begin after the calibration of the gyro
LIMIT = 300.0       # s of simulated time, after which a run is stopped
GRACE = 10.0        # s after a stop, for what the script does then
FRAME = 0.04        # s between two frames


class Stopped(Exception):
    """The run is to be stopped now."""


class RecordedSimulation(Simulation):
    """A Simulation with a filter. tick() raises Stopped when the run is to be stopped."""

    def __init__(self, robot: Robot, surface: Surface | None, seed: int, rate: float, title: str, stop: float | None,
                 as_one_frame: bool) -> None:
        """title: name of the run; stop: s since BEGIN at which it is stopped, None: at its end; as_one_frame: whether
        to record only the result."""
        super().__init__(robot, surface, seed, filtered=True, keep=False, rate=rate)
        self.stop = BEGIN + min(LIMIT if stop is None else stop, LIMIT) * SECOND
        self.outcome = f'stopped, because {LIMIT:g} s have passed' if stop is None else 'stopped'
        self.was_stopped = False
        self.frame_period = inf if as_one_frame else FRAME * SECOND
        self.frame_time: float = BEGIN      # ns, of the next frame
        self.frames: list[str] = []         # as JSON
        self.sent = 0, -1                   # number and epoch of the last frame, see PageState.frame()
        self.state = PageState()
        self.state.set_status(base='simulated', simulated=True, simulated_time=True, can_reset=True, driver='',
                              surface=surface.name if surface else 'ideal', seed=str(seed), started=title, outcome='')

    def tick(self) -> None:
        trace = sys.gettrace()
        sys.settrace(None)      # of a script: calling it here would take as long as the simulation
        super().tick()
        if self.now >= BEGIN:
            self._record()
        sys.settrace(trace)
        if self.now >= self.stop:
            self.stop, self.was_stopped = self.now + GRACE * SECOND, True
            raise Stopped

    def _record(self) -> None:
        snapshot, base, now = self.snapshot(), self.base, self.now / SECOND
        self.state.move('odometry', PoseAndSpeed(now, snapshot.odometry, *base.velocity), now)
        self.state.move('truth', PoseAndSpeed(now, snapshot.truth, *base.true_velocity), now)
        if snapshot.estimate:
            self.state.move('estimate', PoseAndSpeed(now, snapshot.estimate, 0.0, 0.0), now)
        self.state.command(base.gate.linear, base.gate.angular, '', now)
        if self.now >= self.frame_time:
            self.frame_time = self.now + self.frame_period
            self.add_frame()

    def log(self, level: int, text: str) -> None:
        """Add a line to the log."""
        self.state.log_line(level, max(0, self.now - BEGIN) / SECOND, '/out_and_back', text)

    def come_to_rest(self) -> None:
        """Let the robot drive until its last command times out."""
        end = self.now + GRACE * SECOND
        while not self.base.at_rest and self.now < end:
            try:
                self.tick()
            except Stopped:
                self.base.command(self.now, 0.0, 0.0)

    def finish(self, outcome: str) -> None:
        """Record the last frame, whose poses are not rounded."""
        self.state.run.poses.update(zip(('truth', 'odometry', 'estimate'), filter(None, self.snapshot()[1:])))
        self.state.set_status(outcome=self.outcome if self.was_stopped else outcome)
        self.add_frame()

    def add_frame(self) -> None:
        """Record a frame with all that has changed since the last one."""
        number, epoch, frame = self.state.frame(*self.sent, self.now / SECOND)
        self.sent = number, epoch
        self.frames.append(frame.decode())
