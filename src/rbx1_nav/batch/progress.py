"""Progress of many runs: a bar in a terminal, lines in a pipe."""
from __future__ import annotations

import sys
import time

from tqdm import tqdm

MOMENT = 1.0    # s: a bar appears after this time
PAUSE = 10.0    # s between two lines
FORMAT = '{desc}: {n_fmt} of {total_fmt} runs, {rate_noinv_fmt}, {remaining} left'


class Progress:
    """Shows on stderr how many runs are done, how many there are in a second, and the time left."""

    def __init__(self, total: int) -> None:
        self.total, self.done, self.counted = total, 0, 0
        self.start = self.shown = time.monotonic()
        self.bar: tqdm[None] | None = None

    def add(self, runs: int, title: str, computed: bool) -> None:
        """Count runs, which were computed now or before; show the title of the current ones."""
        self.done += runs
        if not computed:
            self.counted += runs
            return
        now = time.monotonic()
        if self.bar is None and sys.stderr.isatty() and now > self.start + MOMENT:
            self.bar = tqdm(total=self.total, initial=self.done - runs, unit='run', leave=False)
        if self.bar is not None:
            self.bar.set_description(title, refresh=False)
            self.bar.update(runs)
        elif now > self.shown + PAUSE:
            rate = (self.done - self.counted) / (now - self.shown)      # since the last line: the methods differ
            self.shown, self.counted = now, self.done
            print(tqdm.format_meter(self.done, self.total, now - self.start, unit=' runs', bar_format=FORMAT,
                                    prefix=title, rate=rate), file=sys.stderr, flush=True)

    def print(self, text: str) -> None:
        """Print text to stdout, above the bar."""
        with tqdm.external_write_mode():
            print(text, flush=True)

    def close(self) -> None:
        """Remove the bar."""
        if self.bar is not None:
            self.bar.close()
