"""Detects commands that arrive in a burst, long after they were sent."""
from __future__ import annotations

from rbx1_nav.base.units import SECOND

CLOSE = SECOND // 1000  # ns: no live sender sends so fast for long; joy_node joins what happens within this time
TOGETHER = 3        # commands that a live sender may send at once: one that is late, and up to two of rospy.Rate
APART = 2           # consecutive commands that are not close, after which the sender is live
LONGEST = SECOND // 2       # ns: a sender that sends for longer is live
MAX_SENDERS = 20    # senders that are stored


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
