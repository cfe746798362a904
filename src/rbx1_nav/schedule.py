"""When something periodic is due, on any clock."""
from rbx1_nav.base import SECOND


class Schedule:
    """Says when something periodic is due, also on a clock that jumps."""

    def __init__(self, rate):
        """rate: Hz."""
        self.period = round(SECOND / rate)
        self.last = self.next = 0

    def due(self, now):
        """Whether it is time (ns). Asks for being called about once a period or more often."""
        back = now < self.last
        self.last = now
        if now < self.next and not back:
            return False
        late = back or now >= self.next + self.period
        self.next = (now if late else self.next) + self.period
        return True
