"""Determines from the ticks of a driver's commands whether its first command was sent one tick before it arrived."""
from __future__ import annotations

LENGTH = 16     # commands that are examined
ENOUGH = 10     # commands that are enough to determine any rate


class Stream:
    """The commands of one driver from its first motion to its next stop.

    A driver that wakes by itself, and not because of a tick, may begin while the next tick is already being delivered.
    Then its rate counts from the previous tick, but its first command arrives at this tick: the motion would be one
    tick too short. At the usual rates, the ticks of the following commands show this. Every later change of the
    motion then takes effect one tick later.
    """

    def __init__(self, tick: int, command: tuple[float, float], uncertain: bool) -> None:
        """tick: number of the tick at which the first command, `command`, arrived; uncertain: whether this command may
        have been sent before that tick."""
        self.command = command
        self.ticks = [tick]
        self.uncertain = uncertain
        self.lag = 0
        self.unprompted = 0     # commands that no tick has prompted
        self.last = tick
        self.in_a_row = 1       # ticks up to the last one, each with one command

    def lag_of(self, tick: int, command: tuple[float, float]) -> int:
        """Return how many ticks later another command, which arrives at `tick`, takes effect."""
        self.in_a_row = self.in_a_row + 1 if tick == self.last + 1 else 0
        self.last = tick
        if self.uncertain:
            # the first command that differs need not follow the rate: it is used only if there are too few others
            if command == self.command or len(self.ticks) < ENOUGH:
                self.ticks = (self.ticks + [tick])[:LENGTH]
            if command != self.command:
                self.uncertain = False
                self.lag = int(is_late(self.ticks))
        return self.lag


def is_late(ticks: list[int]) -> bool:
    """Return whether the first command was sent one tick earlier than in `ticks`, and the others as in `ticks`."""
    if len(ticks) < ENOUGH:
        # a rate that begins with the first command waits for a whole period, rounded up: no later gap is longer
        first, *others = [after - before for before, after in zip(ticks, ticks[1:])]
        return bool(others) and first < max(others)
    return possible_periods([ticks[0] - 1] + ticks[1:]) > max(0, possible_periods(ticks))


def possible_periods(ticks: list[int]) -> float:
    """Return the width of the range of periods, in ticks, with which a rate sends at exactly these ticks.

    The times of a rate are one period apart. It sends at the first tick that is not before each of its times. The width
    is negative if no rate fits.

    Command k at tick n[k] means that n[k] - 1 < begin + k * period <= n[k]; two commands i before k then give
    (n[k] - n[i] - 1) / (k - i) < period < (n[k] - n[i] + 1) / (k - i).
    """
    pairs = [(ticks[k] - ticks[i], k - i) for k in range(len(ticks)) for i in range(k)]
    return min((length + 1) / count for length, count in pairs) - max((length - 1) / count for length, count in pairs)
