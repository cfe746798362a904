"""The state that the page shows: poses, paths, speeds, the end poses of the previous run, log, and status."""
from __future__ import annotations

from math import hypot, isfinite
from threading import Lock
from typing import Any, Mapping, NamedTuple, Sequence

from rbx1_nav.extras.web.history import LOG_LINES, Counter, Path, Series, Speeds
from rbx1_nav.extras.web.page_messages import encode

SOURCES = ('truth', 'odometry', 'estimate')     # sources of poses
BY_HAND = 'by hand'   # sender of the commands of this node
SPEEDS = ('commanded', 'reported', 'true')
JUMP = 0.5          # m between two odometry messages: the robot was moved by hand or reset, or it is another robot
BACK = 0.5          # s by which the stamps go back if simulated time has restarted
REST = 0.005        # m/s, rad/s: encoder noise of a robot at rest
MOVED = 0.02, 0.05  # m, rad: a run that never left its start is not stored as the previous run
RESET_DELAY = 0.5   # s: largest delay between the message about a reset and the odometry after it, in either order
SILENCE = 3.0       # s without a message after which a pose is no longer shown
DRIVING_TIMEOUT = 2.0   # s without a motion after which a node no longer drives; a script rests for 1 s between motions
COMMAND_TIMEOUT = 1.0   # s without a command after which the commanded speed is 0
FACTOR_PERIOD = 2.0     # s of wall time
LOG_TEXT = 300          # characters

PoseRow = Sequence[float]   # x, y, yaw: m, rad


class PoseAndSpeed(NamedTuple):
    """Pose and velocity from an Odometry message."""

    time: float         # s, stamp of the message
    pose: PoseRow
    linear: float       # m/s
    angular: float      # rad/s


class Run:
    """What belongs to one run: from a reset, or the connection of a base, to the next."""

    def __init__(self, counter: Counter, origin: float | None) -> None:
        """origin: stamp at which the run begins, s; None before the first odometry."""
        self.name = ''          # the run or node that drives the robot, or drove it last
        self.origin = origin
        self.travelled = False  # whether the robot has left its start
        self.paths = {source: Path(counter) for source in SOURCES}
        self.speeds = {name: Speeds(counter, steps=name == 'commanded') for name in SPEEDS}
        self.poses: dict[str, PoseRow] = {}
        self.silent: dict[str, PoseRow] = {}    # last poses of sources that have become silent
        self.away: dict[str, tuple[float, PoseRow]] = {}    # by source: time, last pose that is not the origin

    def time(self, stamp: float) -> float | None:
        """Return the time since the beginning of the run, s, or None before the first odometry."""
        return None if self.origin is None else stamp - self.origin


class PageState:
    """The state that the page shows. ROS threads write it, and the server thread reads it."""

    def __init__(self) -> None:
        self.lock = Lock()
        self.counter = Counter()
        self.log = Series(self.counter, LOG_LINES)      # [level, time, node, text]
        self.run = Run(self.counter, None)
        self.epoch = 0          # number of the run
        self.before: dict[str, PoseRow] = {}    # end poses of the previous run
        self.other: tuple[str, float] = '', -DRIVING_TIMEOUT    # node that has moved the robot, and when
        self.heard: dict[str, float] = {}       # s, monotonic clock: last message, by source
        self.late: dict[str, float] = {}    # s, by source: until then, a pose away from the start precedes the reset
        self.last: tuple[float, float] | None = None    # last odometry message: stamp and monotonic clock, s
        self.speed = 0.0        # in the last odometry message, the larger of m/s and rad/s
        self.factor = 1.0       # how fast simulated time advances, relative to real time
        self.measured: tuple[float, float] | None = None    # s: stamp and monotonic clock when its measurement began
        self.last_command = 0.0     # s, monotonic clock
        self.status: dict[str, Any] = {}
        self.status_number = self.counter.next()

    def move(self, source: str, motion: PoseAndSpeed, now: float) -> None:
        """Process a pose from a source. now: s, monotonic clock. Values that are not finite are ignored."""
        if not all(map(isfinite, (motion.time, *motion.pose, motion.linear, motion.angular))):
            return
        with self.lock:
            if now < self.late.get(source, 0.0) and moved(motion.pose):
                return
            self.late.pop(source, None)
            if source == 'odometry':
                self._keep_time(motion, now)
                self.speed = max(abs(motion.linear), abs(motion.angular))
            run, pose = self.run, [round(value, 4) for value in motion.pose]
            if pose != run.poses.get(source):
                self.counter.next()
            run.poses[source], self.heard[source] = pose, now
            if any(pose):
                run.away[source] = now, pose
            run.travelled = run.travelled or moved(pose)
            run.paths[source].move(*motion.pose)
            time = run.time(motion.time)
            if time is not None and source != 'estimate':
                name = 'true' if source == 'truth' else 'reported'
                run.speeds[name].sample(time, motion.linear, motion.angular)

    def _keep_time(self, motion: PoseAndSpeed, now: float) -> None:
        last = self.run.poses.get('odometry')
        jumped = last is not None and hypot(motion.pose[0] - last[0], motion.pose[1] - last[1]) > JUMP
        if self.last is None or motion.time < self.last[0] - BACK or jumped:
            if self.last is not None:
                self._begin()
            self.run.origin, self.measured = motion.time, None
        self.last = motion.time, now
        if self.measured and now - self.measured[1] > FACTOR_PERIOD:
            self.factor = max(0.0, (motion.time - self.measured[0]) / (now - self.measured[1]))
            self.measured = None
        self.measured = self.measured or self.last

    def command(self, linear: float, angular: float, sender: str, now: float) -> None:
        """Process a command. sender: name of the node that published it."""
        if not (isfinite(linear) and isfinite(angular)):
            return
        with self.lock:
            self.last_command = now
            if linear or angular:
                running = self.status.get('started') and not self.status.get('outcome')
                self.run.name = self.status['started'] if running else sender
                if not running and sender != BY_HAND:
                    self.other = sender, now
            self._commanded(linear, angular, now)

    def _commanded(self, linear: float, angular: float, now: float) -> None:
        if self.last is None:
            return
        # a Twist has no stamp: derive its time from the last odometry message
        time = self.run.time(self.last[0] + min(now - self.last[1], 1.0) * self.factor)
        if time is not None:
            self.run.speeds['commanded'].sample(time, linear, angular)

    def hears(self, source: str) -> bool:
        """Return whether a source sends poses. After a reset this stays true, although there is no pose at first."""
        return source in self.heard

    def other_driver(self, now: float) -> str:
        """Return the name of a node that drives the robot and was not started by the page, or ''. now: s, monotonic."""
        name, time = self.other
        return name if now - time < DRIVING_TIMEOUT else ''

    def last_speed(self) -> tuple[float, float]:
        """Return the larger of m/s and rad/s in the last odometry, and when it arrived (s, monotonic; 0: never)."""
        with self.lock:
            return self.speed, self.last[1] if self.last else 0.0

    def forget_driver(self) -> None:
        """Forget which node drove, because all of them were stopped."""
        self.other = '', -DRIVING_TIMEOUT

    def tick(self, now: float) -> None:
        """Time out a command that is not repeated, and remove silent sources. To be called periodically."""
        self.set_status(driver=self.other_driver(now))
        with self.lock:
            run, items = self.run, self.run.speeds['commanded'].items
            if items and any(items[-1][1][1:]) and now - self.last_command > COMMAND_TIMEOUT:
                self._commanded(0.0, 0.0, now)
            for source in [each for each, heard in self.heard.items() if now - heard > SILENCE]:
                del self.heard[source]
                if source in run.poses:
                    run.silent[source] = run.poses.pop(source)
                self.counter.next()

    def reset(self, now: float) -> None:
        """Begin a new run, because the robot was put back at its start."""
        with self.lock:
            run = self.run
            run.poses.update({source: pose for source, (time, pose) in run.away.items()
                              if source in run.poses and now - time < RESET_DELAY})
            self._begin()
            self.late = dict.fromkeys(SOURCES, now + RESET_DELAY)

    def connected(self) -> None:
        """Begin a new run, because the odometry comes from another base, or from one that was started again."""
        with self.lock:
            if self.last is not None:
                self._begin()
                self.last = None
                self.heard.clear()      # it may be a real robot now

    def _begin(self) -> None:
        """Begin a new run, and store the end poses of the last one."""
        if self.run.travelled:
            self.before = {**self.run.silent, **self.run.poses}
        self.run = Run(self.counter, self.last[0] if self.last else self.run.origin)
        self.epoch += 1
        self.status_number = self.counter.next()

    def set_status(self, **values: Any) -> None:
        """Set values of the status, which the page shows as text or uses to enable its buttons."""
        with self.lock:
            if any(self.status.get(key) != value for key, value in values.items()):
                self.status.update(values)
                self.status_number = self.counter.next()

    def log_line(self, level: int, time: float, node: str, text: str) -> None:
        """Add a log message of a node. level: of rosgraph_msgs/Log; time: s since 1970."""
        text = text if len(text) <= LOG_TEXT else text[:LOG_TEXT - 3] + '...'
        with self.lock:
            self.log.add([level, round(time, 3), node[:100], text])

    def frame(self, number: int, epoch: int, now: float) -> tuple[int, int, bytes]:
        """Make the frame for a browser that has received everything up to this number, in this epoch.

        now: s, monotonic clock, by which a later request of the browser shows its age.

        Returns the number and the epoch of the browser after this frame, and the encoded message.
        """
        with self.lock:
            series: dict[str, Any] = {}
            groups: dict[str, Mapping[str, Series]] = {'paths': self.run.paths, 'speeds': self.run.speeds}
            for group, members in groups.items():
                found = {name: each.since(number) for name, each in members.items()}
                series[group] = {name: items for name, items in found.items() if items}
            log, time = self.log.since(number), self.run.time(self.last[0]) if self.last else None
            fields: dict[str, Any] = {
                'epoch': self.epoch,
                'clock': round(now, 3),
                'time': None if time is None else round(time, 3),
                'poses': self.run.poses,
                'run': self.run.name,
                **{key: value for key, value in series.items() if value}}
            if log:
                fields['log'] = log
            if self.status_number > number or epoch != self.epoch:
                fields['status'] = dict(self.status, before=self.before, factor=round(self.factor, 1))
            return self.counter.last, self.epoch, encode('frame', **fields)


def moved(pose: PoseRow) -> bool:
    """Return whether a pose differs from the start pose."""
    return hypot(pose[0], pose[1]) > MOVED[0] or abs(pose[2]) > MOVED[1]
