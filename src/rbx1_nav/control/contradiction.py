"""Notices nodes that drive one base at the same time, each in its own way."""
from threading import Lock

from rbx1_nav.units import SECOND

WINDOW = SECOND // 2    # ns: a sender that was silent for longer has left the base to another one


class Senders:
    """Remembers the last command of each sender, and how many contradicted those of another one."""

    def __init__(self):
        self.latest = {}        # by id of the connection: (connection, time in ns, name, command)
        self.contradictions = 0
        self.last = None        # (time in ns, text) of the last contradiction
        self.lock = Lock()      # commands of several senders arrive in several threads

    def contradiction(self, now, connection, name, command, connections):
        """A text that names both senders and their commands, if commands alternate and differ; else None.

        now: ns; connection: any object, one per sender; command: (m/s, rad/s); connections(): those that still exist.
        A sender that takes over is no contradiction: its commands do not alternate with those of another one.
        """
        with self.lock:
            before = self.latest.pop(id(connection), None)
            others = list(self.latest.values())     # the oldest first, for a command moves its sender to the end
            self.latest[id(connection)] = connection, now, name, command
            if not others:
                return None
            if before is None:      # seldom enough to look for those that have gone
                live = set(map(id, connections()))
                self.latest = {key: value for key, value in self.latest.items()
                               if key in live or key == id(connection)}
                return None
            for other, time, other_name, other_command in reversed(others):
                if (other_command != command and before[1] <= time and 0 <= now - before[1] <= WINDOW
                        and any(each is other for each in connections())):
                    self.contradictions += 1
                    text = '%s sends %g m/s, %g rad/s, %s sends %g m/s, %g rad/s' % (
                        (name,) + command + (other_name,) + other_command)
                    self.last = now, text
                    return text
        return None

    def recent(self, now, age):
        """The text of the last contradiction, if it is not older than `age` (ns); else None."""
        return self.last[1] if self.last and 0 <= now - self.last[0] <= age else None
