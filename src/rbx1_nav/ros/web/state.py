"""What the page shows: poses, paths, speeds, the table of this run and the one before, log lines, and a status."""
from __future__ import annotations

from math import hypot, isfinite
from threading import Lock
from typing import Any, Mapping, NamedTuple, Sequence

from rbx1_nav.ros.web.history import Counter, Log, Path, Series, Speeds
from rbx1_nav.ros.web.protocol import encode

SOURCES = ('truth', 'odometry', 'estimate')     # of poses
SPEEDS = ('commanded', 'reported', 'true')
JUMP = 0.5          # m between two messages of the odometry: the robot was put elsewhere
BACK = 0.5          # s by which time goes back where it began again
MOVED = 0.02, 0.05  # m, rad: a run that has never left its start is not kept as the run before
RESET_DELAY = 0.5   # s by which the message about a reset may be later than the odometry after it, or earlier
SILENCE = 3.0       # s without a message after which the robot is no longer shown at its last pose
COMMAND_TIMEOUT = 1.0   # s: without a command for this time, none is in force

PoseRow = Sequence[float]   # x, y, yaw: m, rad


class Motion(NamedTuple):
    """A pose and a velocity, as an Odometry message has them."""

    time: float         # s, of the stamp
    pose: PoseRow
    linear: float       # m/s
    angular: float      # rad/s


class State:
    """The state of the page. ROS threads write it, and the server reads it."""

    def __init__(self) -> None:
        self.lock = Lock()
        self.counter = Counter()
        self.paths = {source: Path(self.counter) for source in SOURCES}
        self.speeds = {name: Speeds(self.counter, steps=name == 'commanded') for name in SPEEDS}
        self.log = Log(self.counter)
        self.poses: dict[str, PoseRow] = {}
        self.heard: dict[str, float] = {}       # s of the monotonic clock, by source
        self.before: dict[str, PoseRow] = {}    # of the run before
        self.before_name = ''
        self.run_name = ''      # what drives, or drove last
        self.epoch = 0          # counts runs: with a new one, paths and speeds begin again
        self.travelled = False      # whether this run has left its start
        self.late: dict[str, float] = {}    # s, by source: until then, a pose may be older than the reset
        self.away: dict[str, tuple[float, PoseRow]] = {}    # the last pose other than the origin, and when
        self.origin: float | None = None        # s: the stamp at which the page's time is 0
        self.last: tuple[float, float] | None = None    # stamp of the odometry, and the monotonic clock, s
        self.factor = 1.0       # of simulated time, measured
        self.mark: tuple[float, float] | None = None    # where measuring it began
        self.last_command = 0.0     # s of the monotonic clock
        self.status: dict[str, Any] = {}
        self.status_number = self.counter.next()

    def move(self, source: str, motion: Motion, now: float) -> None:
        """A message of a source of poses. now: s of the monotonic clock. One that is not finite is ignored."""
        if not all(map(isfinite, (motion.time, *motion.pose, motion.linear, motion.angular))):
            return
        with self.lock:
            if now < self.late.get(source, 0.0) and moved(motion.pose):
                return
            self.late.pop(source, None)
            if source == 'odometry':
                self._keep_time(motion, now)
            pose = [round(value, 4) for value in motion.pose]
            if pose != self.poses.get(source):
                self.counter.next()
            self.poses[source], self.heard[source] = pose, now
            if any(pose):
                self.away[source] = now, pose
            self.travelled = self.travelled or moved(pose)
            self.paths[source].move(*motion.pose)
            if self.origin is not None and source != 'estimate':
                name = 'true' if source == 'truth' else 'reported'
                self.speeds[name].sample(motion.time - self.origin, motion.linear, motion.angular)

    def _keep_time(self, motion: Motion, now: float) -> None:
        last = self.poses.get('odometry')
        jumped = last is not None and hypot(motion.pose[0] - last[0], motion.pose[1] - last[1]) > JUMP
        if self.last is None or motion.time < self.last[0] - BACK or jumped:
            if self.last is not None:
                self._begin()
            self.origin, self.mark = motion.time, None
        self.last = motion.time, now
        if self.mark is None or now - self.mark[1] > 2:
            if self.mark is not None:
                self.factor = max(0.0, (motion.time - self.mark[0]) / (now - self.mark[1]))
            self.mark = self.last

    def command(self, linear: float, angular: float, sender: str, now: float) -> None:
        """A Twist of a node, or of a run that the page has started."""
        if not (isfinite(linear) and isfinite(angular)):
            return
        with self.lock:
            self.last_command = now
            if linear or angular:
                running = self.status.get('started') and not self.status.get('outcome')
                self.run_name = self.status['started'] if running else sender
            self._commanded(linear, angular, now)

    def _commanded(self, linear: float, angular: float, now: float) -> None:
        if self.last is not None and self.origin is not None:
            # the message has no stamp: its time is derived from the last odometry message
            time = self.last[0] - self.origin + min(now - self.last[1], 1.0) * self.factor
            self.speeds['commanded'].sample(time, linear, angular)

    def tick(self, now: float) -> None:
        """To be called regularly: a command that is not repeated times out, and a source that is silent vanishes."""
        with self.lock:
            items = self.speeds['commanded'].items
            if items and any(items[-1][1][1:]) and now - self.last_command > COMMAND_TIMEOUT:
                self._commanded(0.0, 0.0, now)
            for source in [each for each, heard in self.heard.items() if now - heard > SILENCE]:
                del self.heard[source], self.poses[source]
                self.counter.next()

    def reset(self, now: float) -> None:
        """The robot was put back to its start: another run begins."""
        with self.lock:
            self.poses.update({source: pose for source, (time, pose) in self.away.items()
                               if source in self.poses and now - time < RESET_DELAY})
            self._begin()
            self.late = dict.fromkeys(SOURCES, now + RESET_DELAY)

    def _begin(self) -> None:
        """Another run: keep the table of the last one, and clear paths and speeds."""
        if self.travelled:
            self.before, self.before_name = dict(self.poses), self.run_name
        self.poses.clear()
        self.away.clear()
        self.travelled = False
        self.run_name = ''
        self.epoch += 1
        self.status_number = self.counter.next()
        for series in (*self.paths.values(), *self.speeds.values()):
            series.clear()
        if self.last is not None:
            self.origin = self.last[0]

    def set_status(self, **values: Any) -> None:
        """Set values of the status: those that the page shows as text, and those that enable its buttons."""
        with self.lock:
            if any(self.status.get(key) != value for key, value in values.items()):
                self.status.update(values)
                self.status_number = self.counter.next()

    def log_line(self, level: int, time: float, node: str, text: str) -> None:
        """A node has logged a line."""
        with self.lock:
            self.log.line(level, time, node, text)

    def frame(self, number: int, epoch: int) -> tuple[int, int, bytes]:
        """The frame for a browser that has everything up to a number, of an epoch.

        Returns the number and the epoch that it has afterwards, and the message.
        """
        with self.lock:
            series: dict[str, Any] = {}
            groups: dict[str, Mapping[str, Series]] = {'paths': self.paths, 'speeds': self.speeds}
            for group, members in groups.items():
                found = {name: each.since(number) for name, each in members.items()}
                series[group] = {name: items for name, items in found.items() if items}
            log = self.log.since(number)
            fields: dict[str, Any] = {
                'epoch': self.epoch,
                'time': round(self.last[0] - self.origin, 3) if self.last and self.origin is not None else None,
                'poses': self.poses,
                'run': self.run_name,
                **{key: value for key, value in series.items() if value}}
            if log:
                fields['log'] = log
            if self.status_number > number or epoch != self.epoch:
                fields['status'] = dict(self.status, before=self.before, before_name=self.before_name,
                                        factor=round(self.factor, 1))
            return self.counter.last, self.epoch, encode('frame', **fields)


def moved(pose: PoseRow) -> bool:
    """Return whether a pose differs from the start pose."""
    return hypot(pose[0], pose[1]) > MOVED[0] or abs(pose[2]) > MOVED[1]
