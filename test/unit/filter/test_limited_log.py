"""The log of the filter has at most one line of a kind per second, and ten in all."""
from rbx1_nav.filter import filter_status


def test_a_flood(monkeypatch):
    log, lines, now = filter_status.LimitedLog(), [], [1000.0]
    monkeypatch.setattr(filter_status.time, 'monotonic', lambda: now[0])

    def run(*texts):
        """Add the texts 50 times per second, each with a different number; return the number of lines in 10 s."""
        lines.clear()
        for _ in range(500):
            for text in texts:
                log.add(lambda form, line: lines.append(form % line), text % now[0])
            now[0] += 0.02
        return len(lines)
    assert 9 <= run('odom: header.stamp: %.9f: expected 1e-05') <= 11
    assert 18 <= run('a: %g', 'b: %g') <= 22
    assert 90 <= run(*['%s: %%g' % name for name in 'abcdefghijklmnopqrstuvwxyz']) <= 110
