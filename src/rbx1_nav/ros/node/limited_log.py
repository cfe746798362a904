"""A log that is limited to two lines per second."""
from __future__ import annotations

import re
from threading import Lock
from typing import Callable

INTERVAL = 0.5      # s between two lines
KIND_INTERVAL = 1.0     # s between two lines of one kind
MAX_KINDS = 100     # kinds waiting to be logged; further kinds are dropped
NUMBER = re.compile(r'[-+]?\b(\d[\d.]*(e[-+]?\d+)?|nan|inf)\b')


class LimitedLog:
    """Keeps lines until they may be logged: the latest line of each kind, and the number of lines.

    Lines that differ only in numbers are of the same kind.
    """

    def __init__(self) -> None:
        # by kind, the oldest first: (log, text, number of lines)
        self.pending: dict[str, tuple[Callable[..., None], str, int]] = {}
        self.logged: dict[str, float] = {}      # by kind: time of the last logged line, s
        self.next = 0.0         # s
        self.lock = Lock()

    def add(self, log: Callable[..., None], text: str) -> None:
        """Add a line, from any thread. log: a function such as rospy.logwarn."""
        kind = NUMBER.sub('', text)
        with self.lock:
            if kind in self.pending or len(self.pending) < MAX_KINDS:
                self.pending[kind] = log, text, self.pending.get(kind, (log, text, 0))[2] + 1

    def flush(self, now: float) -> None:
        """Log at most one line. To be called often; now: s of a monotonic clock."""
        with self.lock:
            self.logged = {kind: time for kind, time in self.logged.items() if now - time < KIND_INTERVAL}
            kind = next((each for each in self.pending if each not in self.logged), None)
            if kind is None or now < self.next:
                return
            log, text, count = self.pending.pop(kind)
            self.logged[kind], self.next = now, now + INTERVAL
        log('%s', text if count == 1 else f'{text} (and {count - 1} more of this kind)')
