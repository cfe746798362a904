"""Notices nodes that drive one base at the same time, each in its own way."""
from __future__ import annotations

from threading import Lock
from typing import Callable, Iterable, NamedTuple

from rbx1_nav.units import SECOND

WINDOW = SECOND // 2    # ns: a sender that was silent for longer has left the base to another one


class SentCommand(NamedTuple):
    """The last command of a sender."""

    connection: object  # whatever stands for the sender: only its identity counts
    time: int           # ns
    name: str
    command: tuple[float, float]    # m/s, rad/s


class Senders:
    """Remembers the last command of each sender, and how many contradicted those of another one."""

    def __init__(self) -> None:
        self.latest: dict[int, SentCommand] = {}    # by id of the connection
        self.contradictions = 0
        self.last: tuple[int, str] | None = None    # (time in ns, text) of the last contradiction
        self.lock = Lock()      # commands of several senders arrive in several threads

    def contradiction(self, now: int, connection: object, name: str, command: tuple[float, float],
                      connections: Callable[[], Iterable[object]]) -> str | None:
        """A text that names both senders and their commands, if commands alternate and differ; else None.

        now: ns; connection: any object, one per sender; command: (m/s, rad/s); connections(): those that still exist.
        A sender that takes over is no contradiction: its commands do not alternate with those of another one.
        """
        with self.lock:
            before = self.latest.pop(id(connection), None)
            others = list(self.latest.values())     # the oldest first, for a command moves its sender to the end
            self.latest[id(connection)] = SentCommand(connection, now, name, command)
            if not others:
                return None
            if before is None:      # seldom enough to look for those that have gone
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
        """The text of the last contradiction, if it is not older than `age` (ns); else None."""
        return self.last[1] if self.last and 0 <= now - self.last[0] <= age else None
