"""Keeps a simulated clock in step with a driver whose process cannot be observed.

The driver must answer each tick with one command. While the robot rests, the clock runs freely. So when a stream of
commands begins, the clock may be some ticks ahead of the driver, which then answers all of these ticks at once. Its
commands wait in a queue, and each tick takes one command. A publisher that does not use this clock never answers like
this. Three rules detect such publishers.
"""
from __future__ import annotations

from collections import deque
from functools import partial
from math import inf
from threading import Condition
from time import monotonic
from typing import Callable, Deque, Tuple

COMMAND_TIMEOUT = 1.0   # s of wall time that a tick waits for its command
PROOF = 25              # ticks: a driver that has answered this many ticks uses this clock
PROVEN_TIMEOUT = 5.0          # s of wall time that a tick waits for such a driver
FIRST_QUIET = 0.1       # s of wall time without a command after which a driver's first burst is over
QUIET = 0.03            # s of wall time: replaces FIRST_QUIET at the start of each later stream
SLOW_ANSWER = 0.05      # s of wall time: a command after this time may not be an answer to the tick
BURST_TIME = 1.0        # s of wall time: a burst answers at most the ticks of this period
MAX_BACKLOG = 25        # commands: a queue that has grown by more than this receives more than one command per tick

ReceivedCommand = Tuple[float, ...]     # linear (m/s), angular (rad/s), and the remaining values


class NotInStep(Exception):
    """Raised if a driver does not answer the ticks.

    The text describes what the driver does instead.
    """


class Answers:
    """The commands of one driver, one for each tick."""

    def __init__(self, ticks: Deque[float], changed: Condition, connected: Callable[[], bool],
                 unread: Callable[[], bool], ended: Callable[[], bool]) -> None:
        """ticks: times of the ticks in the last BURST_TIME, s of the monotonic clock; changed: a Condition that is
        notified when a command arrives; connected(): whether the driver is still connected; unread(): whether commands
        have arrived that have not been received yet; ended(): whether to stop waiting."""
        self.ticks = ticks
        self.changed = changed
        self.connected = connected
        self.unread = unread
        self.ended = ended
        # one command per tick; more if the clock ran ahead of the driver at first
        self.queue: Deque[ReceivedCommand] = deque()
        self.received = 0
        self.quiet = FIRST_QUIET
        self.lag = 0                # length of the queue when the stream began
        self.streaming = False      # the last command was a motion, so the next tick will bring another command
        self.answered = 0           # ticks that were answered with one command each

    @property
    def proven(self) -> bool:
        """Whether the driver is known to use this clock. If it then appears not to, the machine is busy."""
        return self.answered >= PROOF

    def receive(self, command: ReceivedCommand) -> None:
        """Accept a command that just arrived."""
        self.received += 1
        self.queue.append(command)

    def next(self) -> ReceivedCommand | None:
        """Wait for the command of this tick, and return it, or None if there is none. Raises NotInStep.

        Call this for each tick, with `changed` held.
        """
        if self.streaming:
            self._wait_for_answer()
        elif self.queue:
            self._begin_stream()
        command = None
        if self.queue:
            command = self.queue.popleft()
            linear, angular, *_ = command
            self.streaming = 0 < abs(linear) < inf or 0 < abs(angular) < inf    # both are false for nan
            if self.streaming and len(self.queue) <= self.lag:
                self.answered += 1
        if len(self.queue) > self.lag + MAX_BACKLOG and not self.proven:
            raise NotInStep('sends more than one command per tick')
        return command

    def _begin_stream(self) -> None:
        """Let the driver answer all ticks that it has seen, because the clock ran freely until now."""
        self._wait_until_quiet(self.quiet)
        self.quiet = QUIET
        self.lag = len(self.queue)
        if self.lag > len(self.ticks) + MAX_BACKLOG:
            raise NotInStep('sends more than one command per tick')

    def _wait_for_answer(self) -> None:
        start = monotonic()
        patience = PROVEN_TIMEOUT if self.proven else COMMAND_TIMEOUT
        if not self._wait_for(lambda: bool(self.queue), patience):
            self.streaming = False
            if self.connected() and not self.ended():
                raise NotInStep(f'sent no command for a tick within {patience:g} s')
            return
        waited = monotonic() - start
        if waited > SLOW_ANSWER and not self.proven:
            # a slow answer to this tick, or a stream that ignores the clock?
            self._wait_until_quiet(2 * waited)

    def _wait_until_quiet(self, quiet: float) -> None:
        """Hold the clock until the driver has sent nothing for `quiet` seconds of wall time."""
        deadline = monotonic() + (PROVEN_TIMEOUT if self.proven else max(COMMAND_TIMEOUT, 3 * quiet))
        while monotonic() < deadline and not self.ended():
            received = self.received
            heard = self._wait_for(partial(self._has_received_more_than, received), quiet)
            # unread: the receiving thread may not have run yet
            if not heard and not self.unread():
                return
        if not (self.proven or self.ended()):
            raise NotInStep('sends commands while the clock is held')

    def _has_received_more_than(self, number: int) -> bool:
        return self.received > number

    def _wait_for(self, condition: Callable[[], bool], timeout: float) -> bool:
        """Wait until condition() is true, and return condition().

        The wait takes at most `timeout` s of wall time. It also stops if the driver disconnects or ended() is true.
        """
        deadline = monotonic() + timeout
        while not condition() and self.connected() and not self.ended():
            left = deadline - monotonic()
            if left <= 0:
                break
            self.changed.wait(min(left, 0.1))
        return condition()
