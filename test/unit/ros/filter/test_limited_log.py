"""A log of at most two lines per second counts each line that it drops, and no kind of line hides another one."""
import re

from rbx1_nav.ros.filter.filter_status import LimitedLog


class Log:
    """A LimitedLog with its own clock, flushed 20 times per second."""

    def __init__(self):
        self.limited, self.now, self.lines = LimitedLog(), 1000.0, []

    def run(self, seconds, *texts):
        """Add texts 50 times per second, each with a different number."""
        for _ in range(round(seconds * 50)):
            for text in texts:
                self.limited.add(lambda form, line: self.lines.append((self.now, form % line)), text % self.now)
            self.limited.flush(self.now)
            self.now += 0.02


def test_a_flood_is_one_line_a_second_that_counts_the_others():
    log = Log()
    log.run(10, 'odom: header.stamp: %.9f: expected 1e-05')
    assert 9 <= len(log.lines) <= 11
    # 49 others per second, or 50 with the tick that rounding adds
    assert re.search(r' \(and (49|50) more of this kind\)$', log.lines[1][1])


def test_many_kinds_are_two_lines_a_second_and_all_get_their_turn():
    log, kinds = Log(), ['%s: %%g' % name for name in 'abcdefgh']
    log.run(20, *kinds)
    assert 38 <= len(log.lines) <= 41
    assert all(second[0] - first[0] > 0.99 for first, second in zip(log.lines, log.lines[2:]))
    assert all(sum(line.startswith(kind[:2]) for _, line in log.lines) >= 4 for kind in kinds)
