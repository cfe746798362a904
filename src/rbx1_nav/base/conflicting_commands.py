"""Detects nodes that send conflicting commands to one base at the same time."""
from __future__ import annotations

from threading import Lock
from typing import Callable, Iterable, NamedTuple

from rbx1_nav.base.units import SECOND

WINDOW = SECOND // 2    # ns: a sender that was silent for longer has given up control of the base


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
