"""Finds and starts the robot, detects when it stops responding, and reconnects to it. All times are in ns."""
from __future__ import annotations

from typing import Callable

from rbx1_nav.config import AUTO
from rbx1_nav.create.driver import sequences
from rbx1_nav.create.driver.exchange import Queries, Sender
from rbx1_nav.create.driver.link import Link
from rbx1_nav.create.driver.search import RATES, Found, Search
from rbx1_nav.create.driver.settings import Settings
from rbx1_nav.create.driver.supervisor import Supervisor
from rbx1_nav.units import SECOND

SILENCE = SECOND // 2           # time without a reading after which the robot counts as not answering
FLUSH_WAIT = SECOND // 10       # time without an answer after which garbage may have swallowed the stop
FIRST_WAIT = 3 * SECOND // 10   # time that a robot that is on may need to answer; after it, the robot is started
START_WAIT = SECOND             # time that a robot may need to start; after it, the search begins
ROUNDS_BEFORE_WARNING = 2       # rounds of the search before the first warning


class Contact:
    """Monitors whether the robot answers, and tries to restore contact when it does not."""

    def __init__(self, settings: Settings, sender: Sender, queries: Queries, supervisor: Supervisor,
                 warn: Callable[[str], None]) -> None:
        """warn: logs a line."""
        self.settings = settings
        self.sender = sender
        self.queries = queries
        self.supervisor = supervisor
        self.warn = warn
        self.line: Link | None = None
        self.found: Found | None = None         # the robot on this line, kept while it does not answer
        self.answers = False        # whether readings arrive
        self.started = False        # whether the robot was started since it last answered
        self.dropouts = 0           # number of times that the robot stopped answering
        self.search = Search((settings.baud,) if settings.baud else RATES, settings.wake_robot)
        self.searching = False
        self._flushed = False
        self._attempt = 0           # time of the last attempt to get an answer
        self._refused: Found | None = None      # robot of the wrong type
        self._warned = False        # whether the warning that no robot answers was logged

    def attach(self, now: int, line: Link) -> None:
        """Start using a line that was opened. Sends a stop if the robot is known; otherwise begins the search."""
        self.line = line
        self.answers = False
        if not (self.found and line.is_same):
            self._begin_search(now, line)
            return
        self.searching = False
        line.confirm(self.found.model)
        self._begin_asking(now, line)

    def detach(self) -> None:
        """Handle the loss of the line."""
        self.line = None
        self._lose()
        self.queries.give_up()

    def tick(self, now: int) -> Found | None:
        """Do what is due. Returns a robot that was just found: use its model, then call start()."""
        line, read = self.line, self.queries.read
        if line is None:
            return None
        if self.searching:
            found = self.search.tick(now)
            self._warn_of_silence()
            if found and self._accepts(now, line, found):
                self.searching, self._refused, self.found = False, None, found
                line.confirm(found.model)
                return found
        elif self.answers:
            if read and now - read.time > SILENCE:
                self._lose()
                self.warn('The robot has stopped responding. If it is still moving, stop it by hand: it keeps '
                          'executing its last command')
                self._begin_asking(now, line)
        elif self.started:
            if now - self._attempt > START_WAIT:
                self._begin_search(now, line)
        elif now - self._attempt > FIRST_WAIT:
            self.start(now)
        elif now - self._attempt > FLUSH_WAIT and not self._flushed:
            self._flushed = True
            self._stop_and_ask(now, sequences.FLUSH + sequences.STOP)
        return None

    @property
    def baud(self) -> int:
        """The rate of the robot that was found last, or is expected."""
        return (self.found or self.settings.model).baud

    @property
    def may_ask(self) -> bool:
        """Whether there is a line to a robot whose rate is known, so that any command may be sent."""
        return self.line is not None and self.found is not None and not self.searching

    def hear(self) -> bool:
        """Record that a reading has arrived. Returns whether the robot did not answer before."""
        before, self.answers, self.started = self.answers, True, False
        return not before

    def _lose(self) -> None:
        self.dropouts += self.answers
        self.answers = False
        self.supervisor.forget()

    def _begin_asking(self, now: int, line: Link) -> None:
        self._attempt, self.started, self._flushed = now, False, False
        line.set_rate(self.baud)        # another process may have changed it
        self._stop_and_ask(now)

    def _stop_and_ask(self, now: int, stop: bytes = sequences.STOP) -> None:
        self.sender.stop(now, stop)
        self.queries.ask(now)

    def start(self, now: int) -> None:
        """Start the robot that was found."""
        self._attempt, self.started = now, True
        self.supervisor.restart()
        self._stop_and_ask(now, sequences.STOP + sequences.START)

    # the search

    def _begin_search(self, now: int, line: Link) -> None:
        self.searching = True
        self.search.begin(now, line, self.baud)

    def _accepts(self, now: int, line: Link, found: Found) -> bool:
        """Return whether this robot may be driven; otherwise, the search continues."""
        before = self.found.model.name if self.found else self.settings.robot_type
        if before in (AUTO, found.model.name):
            return True
        self.search.begin(now, line, found.baud)
        if found != self._refused:
            self._refused = found
            self.warn(f'A {found.model.name} answers at {found.baud} baud: expected a {before}; to drive it, restart '
                      f'this node with robot_type:={found.model.name}, or auto')
        return False

    def _warn_of_silence(self) -> None:
        answered = self.search.battery_rates
        if len(answered) >= ROUNDS_BEFORE_WARNING and not self._warned:
            self._warned = True
            self.warn(f'A robot answers at {answered[-1]} baud, but only the query of its battery, as a Roomba of the '
                      '400 series (SCI) does: expected a Create, Create 2, or Roomba 500 or 600')
        if self.search.rounds >= ROUNDS_BEFORE_WARNING and not self._warned and not self.found and not self._refused:
            self._warned = True
            rates = ', '.join(map(str, self.search.rates))
            self.warn(f'No robot answers at {rates} baud: expected a Create, Create 2 or Roomba that is switched on '
                      'and connected')
