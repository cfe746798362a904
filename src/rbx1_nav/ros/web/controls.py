"""Execution of the requests of browsers, and the reasons for rejecting them."""
from __future__ import annotations

import time
from typing import Any, Callable, Protocol

from rbx1_nav.ros.web.hand_drive import HandDrive
from rbx1_nav.ros.web.protocol import Drive, Hand, Hello, Message, Reset, Run, Stop
from rbx1_nav.ros.web.runs import Runs
from rbx1_nav.ros.web.state import State

NO_TOKEN = 'this page can only watch: open the complete address that the web view printed, with its token'
BUSY = 'a run is in progress: stop it first'
NOT_CONFIRMED = 'a real robot moves only after you have confirmed that its path is free'


class System(Protocol):
    """The running system; see system.py."""

    @property
    def simulated(self) -> bool:
        """Whether the robot is known to be simulated."""

    def reset(self) -> None:
        """Put the robot back at its start. Raises an exception if this fails."""

    def shut_down_drivers(self) -> None:
        """Shut down the other nodes that drive the robot."""


class Controls:
    """Executes the requests of browsers."""

    def __init__(self, state: State, system: System, hand: HandDrive, runs: Runs, speeds: tuple[float, float],
                 in_background: Callable[[Callable[[], None]], Any],
                 clock: Callable[[], float] = time.monotonic) -> None:
        """speeds: speeds of the arrow keys, m/s and rad/s; in_background(function): calls the function in a thread."""
        self.state = state
        self.system = system
        self.hand = hand
        self.runs = runs
        self.speeds = speeds
        self.in_background = in_background
        self.clock = clock

    def handle(self, browser: object, trusted: bool, message: Message) -> str:
        """Execute a request. trusted: whether the browser sent the token. Returns why it was rejected, or ''."""
        if isinstance(message, Stop):       # anyone who sees a robot move may stop it
            self.stop()
            return ''
        if isinstance(message, Hello):
            return ''
        if not trusted:
            return NO_TOKEN
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
        if not self.runs.start(message.method, self._reset_robot if reset else self.hand.wait_until_closed):
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
                self._reset_robot()
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

    def _reset_robot(self) -> None:
        self.hand.wait_until_closed()   # the base warns of a reset while a node drives
        self.system.reset()

    def stop(self) -> None:
        """Stop the robot, regardless of which node drives it."""
        self.runs.stop()
        self.hand.stop()
        self.system.shut_down_drivers()
        self.state.forget_driver()

    def leave(self, browser: object) -> None:
        """End driving by hand for a browser that has disconnected."""
        self.hand.leave(browser)
