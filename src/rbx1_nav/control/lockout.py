"""Refuses commands of senders that have not noticed that something else stopped the robot."""

from __future__ import annotations

MAX_SENDERS = 20    # senders that are stored before the silent ones are removed


class Lockout:
    """Refuses commands after an event until their sender has sent a zero command or has been silent for a while.

    All times are in ns.
    """

    def __init__(self, silence: int) -> None:
        """silence: how long a sender must be silent."""
        self.silence = silence
        self.reason = ''        # reason of the last event
        self._released: set[str] | None = None      # senders whose commands are accepted; None for all senders
        self._latest: dict[str, int] = {}   # arrival time of the last command, by sender

    def lock(self, reason: str, unobserved: int = 0) -> None:
        """Refuse the commands of all senders, because something has stopped the robot.

        unobserved: time until now in which no command could be received, which does not count as silence.
        """
        self.reason, self._released = reason, set()
        self._latest = {name: time + unobserved for name, time in self._latest.items()}

    def refuses(self, now: int, sender: str, moving: bool) -> bool:
        """Return whether to refuse a command that arrives at `now`.

        sender: name of the sender; moving: whether the command moves the robot.
        """
        last = self._latest.get(sender)
        self._latest[sender] = now
        if len(self._latest) > MAX_SENDERS:
            self._latest = {name: time for name, time in self._latest.items() if now - time <= self.silence}
        if self._released is None or sender in self._released:
            return False
        if moving and last is not None and now - last <= self.silence:
            return True
        self._released.add(sender)
        return False
