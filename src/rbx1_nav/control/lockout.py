"""Keeps a robot that was stopped by something else from being driven on by a sender that has not noticed."""

from __future__ import annotations

MAX_SENDERS = 20    # that are remembered before those are forgotten that have been silent


class Lockout:
    """After an event, a sender is obeyed again as soon as it has sent a zero command, or nothing for a while.

    All times are in ns.
    """

    def __init__(self, silence: int) -> None:
        """silence: how long a sender must have sent nothing."""
        self.silence = silence
        self.reason = ''        # of the last event
        self._released: set[str] | None = None      # the senders that are obeyed; None for all of them
        self._latest: dict[str, int] = {}   # by sender: when its last command arrived

    def lock(self, reason: str) -> None:
        """Something has stopped the robot."""
        self.reason, self._released = reason, set()

    def refuses(self, now: int, sender: str, moving: bool) -> bool:
        """Whether a command that arrives now is not to be obeyed. sender: its name; moving: whether it is a motion."""
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
