"""Checks and limits each velocity command before it reaches a base, simulated or real, and detects commands that arrive
long after they were sent, and nodes that send conflicting commands to one base at the same time.
"""
from __future__ import annotations

from math import inf
from threading import Lock
from typing import Callable, Iterable, NamedTuple, Sequence

from rbx1_nav.base.robot_parameters import Limits
from rbx1_nav.base.units import SECOND, clamp

MAX_COMMAND = 1e6   # m/s or rad/s: far above any robot, and far below where sums overflow
WINDOW = SECOND // 2    # ns: a sender that was silent for longer has given up control of the base

CLOSE = SECOND // 1000  # ns: no live sender sends so fast for long; joy_node joins what happens within this time
TOGETHER = 3        # commands that a live sender may send at once: one that is late, and up to two of rospy.Rate
APART = 2           # consecutive commands that are not close, after which the sender is live
LONGEST = SECOND // 2       # ns: a sender that sends for longer is live
MAX_SENDERS = 20    # senders that are stored


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


class Spacing:
    """The spacing of the commands of a sender. Times are in ns."""

    def __init__(self, now: int) -> None:
        self.last = now
        self.together = self.usual = 1  # numbers of commands that were close to each other: the last ones, and before
        self.checked_since: int | None = None   # first command after a silence, until the sender is known to be live
        self.apart = 0          # number of consecutive commands since then that are not close
        self.is_burst = False

    def is_late(self, now: int, silence: int, was_observed: bool) -> bool:
        """Return whether a command that arrives at `now` belongs to a burst. For the other arguments see Bursts."""
        gap, self.last = now - self.last, now
        is_close = 0 <= gap < CLOSE
        self.usual, self.together = (self.usual, self.together + 1) if is_close else (self.together, 1)
        if gap > silence or gap < 0:
            self.checked_since, self.apart, self.is_burst = now if was_observed else None, 0, False
        elif self.checked_since is not None:
            self.apart = 0 if is_close else self.apart + 1
            self.is_burst = self.is_burst or self.together > max(TOGETHER, self.usual)
            if self.apart >= APART or now - self.checked_since > LONGEST:
                self.checked_since, self.is_burst = None, False
        return self.is_burst


class Bursts:
    """Recognizes commands that arrive long after they were sent: when the network works again after an outage, the
    kernel delivers at once whatever was sent meanwhile, even if the sender has died. A Twist has no time stamp.

    The first command after a silence counts at once. If more arrive together than a live sender sends, they are a
    burst, and the commands of this sender are dropped until two arrive apart.
    """

    def __init__(self, silence: int) -> None:
        """silence: ns after which the base has stopped; 0 if it does not stop, so that no command makes it start."""
        self.silence = silence
        self.spacings: dict[str, Spacing] = {}
        self.ran: int | None = None     # ns, when the base last ran: a silence while it did not run says nothing
        self.dropped = 0                # number of commands

    def drops(self, now: int, sender: str) -> bool:
        """Return whether to drop a command that moves the base and arrives at `now` (ns)."""
        spacing = self.spacings.get(sender)
        if spacing is None:
            if len(self.spacings) >= MAX_SENDERS:
                del self.spacings[min(self.spacings, key=lambda name: self.spacings[name].last)]
            self.spacings[sender] = Spacing(now)
            return False
        was_observed = self.ran is None or now - self.ran < self.silence
        drops = bool(self.silence) and spacing.is_late(now, self.silence, was_observed)
        self.dropped += drops
        return drops


class SentCommand(NamedTuple):
    """The last command of a sender."""

    connection: object  # any object that represents the sender: only its identity matters
    time: int           # ns
    name: str
    command: tuple[float, float]    # m/s, rad/s


class Senders:
    """Stores the last command of each sender, and counts the commands that contradict another sender."""

    def __init__(self) -> None:
        self.latest: dict[int, SentCommand] = {}    # by id of the connection
        self.contradictions = 0
        self.last: tuple[int, str] | None = None    # (time in ns, text) of the last contradiction
        self.lock = Lock()      # commands from different senders arrive in different threads

    def contradiction(self, now: int, connection: object, name: str, command: tuple[float, float],
                      connections: Callable[[], Iterable[object]]) -> str | None:
        """Return a text that names both senders and their commands if commands alternate and differ, else None.

        now: ns; connection: any object, one per sender; command: (m/s, rad/s); connections(): returns the connections
        that still exist. A sender that takes over does not contradict the previous one, because their commands do not
        alternate.
        """
        with self.lock:
            before = self.latest.pop(id(connection), None)
            others = list(self.latest.values())     # the oldest first: each command moves its sender to the end
            self.latest[id(connection)] = SentCommand(connection, now, name, command)
            if not others:
                return None
            if before is None:      # rare: a good moment to remove senders that have disconnected
                live = set(map(id, connections()))
                self.latest = {key: value for key, value in self.latest.items()
                               if key in live or key == id(connection)}
                return None
            for other in reversed(others):
                if (other.command != command and before.time <= other.time and 0 <= now - before.time <= WINDOW
                        and any(each is other.connection for each in connections())):
                    self.contradictions += 1
                    text = (f'{name} sends {command[0]:g} m/s, {command[1]:g} rad/s, '
                            f'{other.name} sends {other.command[0]:g} m/s, {other.command[1]:g} rad/s')
                    self.last = now, text
                    return text
        return None

    def recent(self, now: int, age: int) -> str | None:
        """Return the text of the last contradiction if it is at most `age` (ns) old, else None."""
        return self.last[1] if self.last and 0 <= now - self.last[0] <= age else None
