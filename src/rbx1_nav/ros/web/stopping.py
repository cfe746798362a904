"""Stop: stops the run, driving by hand and all other drivers, and reports what was done and whether the robot rests.

While a Stop is pending, further ones join it, so that many browsers cannot start many threads.
"""
from __future__ import annotations

from typing import Any, Callable, NamedTuple, Protocol

LIMIT = 3.0         # s: time for the robot to come to rest; then the answer is that it has not
REPEAT = 0.2        # s from one search for driving nodes to the next
REST = 0.005        # m/s, rad/s: encoder noise of a robot at rest
LOG_PERIOD = 5.0    # s between two log messages


class Drivers(Protocol):
    """The other nodes that drive the robot; see system.py."""

    @property
    def pending(self) -> bool:
        """Whether nodes are still being shut down."""

    def shut_down_drivers(self) -> None:
        """Shut down the other nodes that drive the robot, in the background."""

    def take_shut_down(self) -> tuple[list[str], list[str], str]:
        """Return the nodes that were shut down since the last call, those that did not answer, and the name of a base
        that subscribes to the commands but is not connected, or ''."""


class Answer(NamedTuple):
    """The answer to a Stop."""

    number: int         # of the request
    stationary: bool    # whether the odometry has reported that the robot is stationary
    text: str


class Stopper:
    """Carries out Stop. The methods may only be called from the server thread."""

    def __init__(self, stop: Callable[[], None], drivers: Drivers, speed: Callable[[float], float | None],
                 log: Callable[[str], None]) -> None:
        """stop(): stops the run and driving by hand, without waiting; speed(since): speed in the
        odometry, the larger of m/s and rad/s, or None without odometry since that time; log(text): logs a message."""
        self.stop = stop
        self.drivers = drivers
        self.speed = speed
        self.log = log
        self.waiting: dict[Any, int] = {}   # browsers that wait for an answer: the number of their request
        self.again = False      # whether a Stop has arrived since the last search for driving nodes
        self.begun = self.next_search = self.next_log = float('-inf')

    def request(self, browser: Any, number: int, now: float) -> None:
        """Stop the robot; answers() returns the answer. now: s, monotonic clock."""
        if not self.waiting:
            self.begun = now
        self.waiting[browser], self.again = number, True
        self.stop()
        self._search(now)
        if now >= self.next_log:
            self.next_log = now + LOG_PERIOD
            self.log(f'Stop from {getattr(browser, "address", "")}')

    def _search(self, now: float) -> None:
        if self.again and now >= self.next_search:
            self.again, self.next_search = False, now + REPEAT
            self.drivers.shut_down_drivers()

    def answers(self, busy: bool, now: float) -> dict[Any, Answer]:
        """Return the answers that are due, by browser. busy: whether a run has not exited yet. Call this often."""
        if not self.waiting:
            return {}
        self._search(now)
        speed = self.speed(self.begun)
        stationary = speed is not None and speed < REST
        stopping = self.again or busy or self.drivers.pending or not stationary
        if stopping and now - self.begun < LIMIT:
            return {}
        stopped, silent, not_connected = self.drivers.take_shut_down()
        texts = [f'Stopped {" and ".join(stopped)}.' if stopped else 'Stopped.' if stationary else
                 'Zero commands were sent.']
        if silent:
            texts.append(f'No answer from {" and ".join(silent)}.')
        if not_connected:
            texts.append(f'{not_connected} does not receive the commands of this page: restart the web view.')
        texts.append('The robot is stationary.' if stationary else
                     'There is no odometry: the robot may still be moving.' if speed is None else
                     'The robot is still moving.')
        waiting, self.waiting = self.waiting, {}
        return {browser: Answer(number, stationary, ' '.join(texts)) for browser, number in waiting.items()}
