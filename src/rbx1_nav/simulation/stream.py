"""The ticks at which a driver sends, and whether its first command was sent one tick before it arrived."""
from __future__ import annotations

LENGTH = 16     # commands that are looked at
ENOUGH = 10     # commands that tell any rate


class Stream:
    """The commands of one driver from its first motion to its next stop.

    A driver that wakes by itself, in place of by a tick, may begin just while the next tick is on its way to it. Then
    its rate counts from the tick before, but its first command arrives at this one: the motion would be short by a
    tick. The ticks of the following commands tell, at the usual rates. Then all that changes the motion later takes
    effect one tick later.
    """

    def __init__(self, tick: int, command: tuple[float, float], uncertain: bool) -> None:
        """tick: number of the tick at which the first command, `command`, arrived; uncertain: whether it may have been
        sent before."""
        self.command = command
        self.ticks = [tick]
        self.uncertain = uncertain
        self.lag = 0
        self.unprompted = 0     # commands that no tick has prompted
        self.last = tick
        self.in_a_row = 1       # ticks up to the last one, each with one command

    def lag_of(self, tick: int, command: tuple[float, float]) -> int:
        """How many ticks later a further command of this tick takes effect."""
        self.in_a_row = self.in_a_row + 1 if tick == self.last + 1 else 0
        self.last = tick
        if self.uncertain:
            # the first command that differs need not be at the same rate: it counts where the others say too little
            if command == self.command or len(self.ticks) < ENOUGH:
                self.ticks = (self.ticks + [tick])[:LENGTH]
            if command != self.command:
                self.uncertain = False
                self.lag = int(is_late(self.ticks))
        return self.lag


def is_late(ticks: list[int]) -> bool:
    """Whether the first command was sent one tick earlier than `ticks` says, the others as it says."""
    if len(ticks) < ENOUGH:
        # a rate that begins with the first command waits for a whole period, rounded up: no later gap is longer
        first, *others = [after - before for before, after in zip(ticks, ticks[1:])]
        return bool(others) and first < max(others)
    return possible_periods([ticks[0] - 1] + ticks[1:]) > max(0, possible_periods(ticks))


def possible_periods(ticks: list[int]) -> float:
    """For how large a range of periods, in ticks, a rate sends at just these ticks: at the first one not before each
    of its times, which lie a period apart. Negative if no rate does.

    Command k at tick n[k] means that n[k] - 1 < begin + k * period <= n[k]; two commands i before k then give
    (n[k] - n[i] - 1) / (k - i) < period < (n[k] - n[i] + 1) / (k - i).
    """
    pairs = [(ticks[k] - ticks[i], k - i) for k in range(len(ticks)) for i in range(k)]
    return min((length + 1) / count for length, count in pairs) - max((length - 1) / count for length, count in pairs)
