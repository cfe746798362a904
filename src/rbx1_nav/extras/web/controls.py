"""Execution of the requests of browsers, and the reasons for rejecting them."""
from __future__ import annotations

import time
from typing import Any, Callable, NamedTuple

from rbx1_nav.extras.web.access import without_token
from rbx1_nav.extras.web.choices import FLOOR, read_choice
from rbx1_nav.extras.web.hand_drive import HandDrive
from rbx1_nav.extras.web.page_messages import (
    ChooseRequest, DriveRequest, HandRequest, Request, RunRequest, StopRequest)
from rbx1_nav.extras.web.page_runs import Runs
from rbx1_nav.extras.web.state import REST, PageState
from rbx1_nav.extras.web.system import System

BUSY = 'a run is in progress: stop it first'
OLD = 'the request was more than 2 s old, so nothing was started: try again'
ROUNDING = 0.001    # s: resolution of the clock in a frame
MAX_AGE = 2.0       # s: age of the last frame that the browser had received when it sent a request
NOT_CONFIRMED = 'a real robot moves only after you have confirmed that its path is free'
LIMIT = 3.0         # s: time for the robot to come to rest; then the answer is that it has not
FRESH = 1.0         # s: older odometry does not tell whether the robot moves; a base that hangs sends none


class Answer(NamedTuple):
    """The answer to a Stop."""

    number: int         # of the request
    stationary: bool    # whether the odometry reports that the robot is stationary
    silent: list[str]   # nodes that have not answered, and may drive the robot again
    text: str


class Stopper:
    """Stops the run, driving by hand and all other drivers, and reports what was done and whether the robot rests.

    While a Stop is pending, further ones join it, so that many browsers cannot start many threads. The methods may only
    be called from the server thread.
    """

    def __init__(self, stop: Callable[[], None], system: System, last_speed: Callable[[], tuple[float, float]],
                 log: Callable[[str], None]) -> None:
        """stop(): stops the run and driving by hand, without waiting; last_speed(): see PageState;
        log(text): logs a message."""
        self.stop = stop
        self.system = system
        self.last_speed = last_speed
        self.log = log
        self.waiting: dict[Any, int] = {}   # browsers that wait for an answer: the number of their request
        self.again = False      # whether a Stop has arrived since the last search for driving nodes
        self.begun = 0.0

    def request(self, browser: Any, number: int, now: float) -> None:
        """Stop the robot; answers() returns the answer. now: s, monotonic clock."""
        if not self.waiting:
            self.begun = now
        self.waiting[browser], self.again = number, True
        self.stop()
        self._search()
        self.log(f'Stop from {browser.address}')

    def _search(self) -> None:
        if self.again and not self.system.searching:
            self.again = False
            self.system.shut_down_drivers()

    def answers(self, busy: bool, now: float) -> dict[Any, Answer]:
        """Return the answers that are due, by browser. busy: whether a run has not exited yet. Call this often."""
        if not self.waiting:
            return {}
        self._search()
        speed, observed = self.last_speed()
        known = observed > max(self.begun, now - FRESH)
        stationary = known and speed < REST
        stopping = self.again or busy or self.system.pending or not stationary
        if stopping and now - self.begun < LIMIT:
            return {}
        stopped, silent = self.system.take_shut_down()
        texts = [f'Stopped {" and ".join(stopped)}.' if stopped else 'Stopped.' if stationary else
                 'Zero commands were sent.']
        if silent:
            texts.append(f'No answer from {" and ".join(silent)}: the robot may move again.')
        since = f'{max(0.0, observed - self.begun):.1f} s after Stop'
        texts.append(f"The robot was {'stationary' if stationary else 'still moving'} {since}." if known else
                     f'There is no odometry later than {since}: the robot may still be moving.')
        waiting, self.waiting = self.waiting, {}
        return {browser: Answer(number, stationary, silent, ' '.join(texts)) for browser, number in waiting.items()}


class Controls:
    """Executes the requests of browsers."""

    def __init__(self, state: PageState, system: System, hand: HandDrive, runs: Runs, speeds: tuple[float, float],
                 in_background: Callable[[Callable[[], None]], Any],
                 clock: Callable[[], float] = time.monotonic, log: Callable[[str], None] = print,
                 stop_needs_token: bool = False) -> None:
        """speeds: speeds of the arrow keys, m/s and rad/s; in_background(function): calls the function in a thread;
        log(text): logs a message."""
        self.state = state
        self.system = system
        self.hand = hand
        self.runs = runs
        self.speeds = speeds
        self.in_background = in_background
        self.clock = clock
        self.log = log
        self.stop_needs_token = stop_needs_token
        self.stopper = Stopper(self._stop, system, state.last_speed, log)

    def handle(self, browser: object, trusted: bool, message: Request) -> str:
        """Execute a request. trusted: whether the browser sent the token. Returns why it was rejected, or ''."""
        refused = '' if trusted else without_token(message, self.stop_needs_token)
        if refused:
            return refused
        if isinstance(message, StopRequest):
            self.stopper.request(browser, message.number, self.clock())
            return ''
        ends = (not message.on if isinstance(message, HandRequest) else
                isinstance(message, DriveRequest) and not any(message[:2]))
        if not ends and not 0 <= self.clock() - message.clock + ROUNDING <= MAX_AGE:
            return OLD
        if isinstance(message, DriveRequest):
            linear, angular = self.speeds
            if self.hand.drive(browser, message.forward * linear, message.left * angular):
                return ''
            return 'another browser is driving the robot, or driving by hand is off'
        if isinstance(message, HandRequest):
            return self._hand(browser, message)
        if isinstance(message, RunRequest):
            return self._run(message)
        if isinstance(message, ChooseRequest):
            return self._choose(message)
        return self._reset()

    def _hand(self, browser: object, message: HandRequest) -> str:
        if not message.on:
            self.hand.leave(browser)
            return ''
        refused = self._reason_against(message.confirmed)
        if not refused:
            self.hand.begin(browser)
        return refused

    def _run(self, message: RunRequest) -> str:
        refused = self._reason_against(message.confirmed)
        if refused:
            return refused
        self._release()
        reset = message.reset and self.system.simulated
        started = self.runs.start(message.method, self._reset_robot if reset else self.hand.wait_until_quiet)
        return '' if started else BUSY

    def _reset(self, before: Callable[[], None] = lambda: None) -> str:
        """Reset the robot. before(): is called before that, in the background."""
        if not self.system.simulated:
            return 'only a simulated robot can be reset'
        refused = self._reason_against(True)
        if refused:
            return refused
        self._release()

        def reset() -> None:
            try:
                before()
                self._reset_robot(lambda: False)
            except Exception as error:
                self.state.set_status(outcome=f'reset failed: {error}')
        self.in_background(reset)
        return ''

    def _choose(self, message: ChooseRequest) -> str:
        name = message.name
        if name not in self.system.choices:
            return 'this cannot be chosen here'
        try:
            value = read_choice(name, message.value, self.system.surfaces)
        except ValueError as error:
            return f'{name}: {error}'
        if name in FLOOR:
            return self._reset(lambda: self.system.choose(name, value))
        self.in_background(lambda: self.system.choose(name, value))
        return ''

    def _reason_against(self, confirmed: bool) -> str:
        """Return why the robot must not be moved now, or ''. confirmed: see RunRequest."""
        if not (self.system.simulated or confirmed):
            return NOT_CONFIRMED
        if self.runs.busy:
            return BUSY
        name = self.state.other_driver(self.clock())
        return f'{name} is driving the robot: stop it first' if name else ''

    def _release(self) -> None:
        """Switch driving by hand off, because two drivers would contradict each other."""
        if self.hand.drivers:
            self.hand.stop()

    def _reset_robot(self, cancelled: Callable[[], bool]) -> None:
        self.hand.wait_until_quiet(cancelled)
        if not cancelled():
            self.system.reset()

    def answers(self) -> dict[Any, Answer]:
        """Return the answers to Stop that are due, by browser. To be called periodically."""
        answers = self.stopper.answers(self.runs.busy, self.clock())
        if answers:     # a command of a driver may have arrived after the request
            self.state.forget_driver()
        return answers

    def _stop(self) -> None:
        self.runs.stop()
        self.hand.stop()
        self.state.forget_driver()

    def leave(self, browser: object) -> None:
        """End driving by hand for a browser that has disconnected."""
        self.hand.leave(browser)
