"""Execution of the requests of browsers, and the reasons for rejecting them."""
from __future__ import annotations

import time
from typing import Any, Callable, Protocol

from rbx1_nav.ros.web.hand_drive import HandDrive
from rbx1_nav.ros.web.protocol import Drive, Hand, Hello, Message, Reset, Run, Stop
from rbx1_nav.ros.web.runs import Runs
from rbx1_nav.ros.web.state import State
from rbx1_nav.ros.web.stopping import Answer, Drivers, Stopper

NO_TOKEN = 'this page can only watch: open the complete address that the web view printed, with its token'
BUSY = 'a run is in progress: stop it first'
OLD = 'the request was more than 2 s old, so nothing was started: try again'
STOP_NEEDS_TOKEN = 'Stop needs the token here: open the complete address that the web view printed'
ROUNDING = 0.001    # s: resolution of the clock in a frame
MAX_AGE = 2.0       # s: age of the last frame that the browser had received when it sent a request
NOT_CONFIRMED = 'a real robot moves only after you have confirmed that its path is free'


class System(Drivers, Protocol):
    """The running system; see system.py."""

    @property
    def simulated(self) -> bool:
        """Whether the robot is known to be simulated."""

    def reset(self) -> None:
        """Put the robot back at its start. Raises an exception if this fails."""


class Controls:
    """Executes the requests of browsers."""

    def __init__(self, state: State, system: System, hand: HandDrive, runs: Runs, speeds: tuple[float, float],
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
        self.stop_needs_token = stop_needs_token
        self.stopper = Stopper(self._stop, system, state.speed_since, log)

    def handle(self, browser: object, trusted: bool, message: Message) -> str:
        """Execute a request. trusted: whether the browser sent the token. Returns why it was rejected, or ''."""
        if isinstance(message, Stop):
            if self.stop_needs_token and not trusted:
                return STOP_NEEDS_TOKEN
            self.stopper.request(browser, message.number, self.clock())
            return ''
        if isinstance(message, Hello):
            return ''
        if not trusted:
            return NO_TOKEN
        ends = isinstance(message, Hand) and not message.on or isinstance(message, Drive) and not any(message[:2])
        if not ends and not 0 <= self.clock() - message.clock + ROUNDING <= MAX_AGE:
            return OLD
        if isinstance(message, Drive):
            linear, angular = self.speeds
            if self.hand.drive(browser, message.forward * linear, message.left * angular):
                return ''
            return 'another browser is driving the robot, or driving by hand is off'
        if isinstance(message, Hand):
            return self._hand(browser, message)
        if isinstance(message, Run):
            return self._run(message)
        return self._reset(message)

    def _hand(self, browser: object, message: Hand) -> str:
        if not message.on:
            self.hand.leave(browser)
            return ''
        if not (self.system.simulated or message.confirmed):
            return NOT_CONFIRMED
        if self.runs.busy:
            return BUSY
        if self._other():
            return self._other()
        self.hand.begin(browser)
        return ''

    def _run(self, message: Run) -> str:
        if not (self.system.simulated or message.confirmed):
            return NOT_CONFIRMED
        if not self.runs.busy and self._other():
            return self._other()
        self._release()
        reset = message.reset and self.system.simulated
        if not self.runs.start(message.method, self._reset_robot if reset else self.hand.wait_until_quiet):
            return BUSY
        return ''

    def _reset(self, _: Reset) -> str:
        if not self.system.simulated:
            return 'only a simulated robot can be reset'
        if self.runs.busy:
            return BUSY
        if self._other():
            return self._other()
        self._release()

        def reset() -> None:
            try:
                self._reset_robot(lambda: False)
            except Exception as error:
                self.state.set_status(outcome=f'reset failed: {error}')
        self.in_background(reset)
        return ''

    def _other(self) -> str:
        """Return the reason for a rejection if another node drives the robot, or ''."""
        name = self.state.other_driver(self.clock())
        return f'{name} is driving the robot: stop it first' if name else ''

    def _release(self) -> None:
        """Switch driving by hand off, because two drivers would contradict each other."""
        if self.hand.drivers:
            self.hand.stop()

    def _reset_robot(self, cancelled: Callable[[], bool]) -> None:
        self.hand.wait_until_quiet(cancelled)   # the base warns of a reset while a node drives
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
