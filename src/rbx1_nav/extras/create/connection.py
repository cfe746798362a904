"""Finds and starts the robot, takes control of it, detects when it stops responding, and reconnects to it.

All times are in ns.
"""
from __future__ import annotations

from typing import Callable, Mapping

from rbx1_nav.base.units import SECOND
from rbx1_nav.extras.create import protocol, sequences
from rbx1_nav.extras.create.create_parameters import Settings
from rbx1_nav.extras.create.identification import RATES, Found, Search
from rbx1_nav.extras.create.queries import Queries
from rbx1_nav.extras.create.sender import ANSWERING, Kind, Phase, Sender
from rbx1_nav.extras.create.serial_port import Link

HOLD = SECOND           # ns without the cause before the driver takes control again
RETRY = SECOND // 2     # ns between two attempts
ATTEMPTS_BEFORE_LOG = 3            # number of attempts that fail without a known cause before the failure is logged
CLIFF = 'a cliff'       # the only cause that a command can remove
SILENCE = SECOND // 2           # time without a reading after which the robot counts as not answering
FLUSH_WAIT = SECOND // 10       # time without an answer after which garbage may have swallowed the stop
FIRST_WAIT = 3 * SECOND // 10   # time that a robot that is on may need to answer; after it, the robot is started
START_WAIT = 2 * SECOND         # time that a robot may need to start, or to answer after a hang; then the search begins
ROUNDS_BEFORE_WARNING = 2       # rounds of the search before the first warning


def causes(reading: Mapping[str, int]) -> list[str]:
    """Return the reasons why a robot with this reading leaves safe mode."""
    found = []
    if reading['bumps_and_wheel_drops'] & protocol.WHEEL_DROPS:
        found.append('a wheel dropped')
    if any(reading[name] for name in protocol.CLIFFS):
        found.append(CLIFF)
    if reading['charging_sources'] & protocol.CHARGER:
        found.append('the charger is plugged in')
    return found


class Supervisor:
    """Decides which mode to request, and when. A robot that reports its mode plus one may seem to be in the wanted mode
    before it was requested, so the mode counts only afterwards."""

    def __init__(self, mode: int, plus_one: bool | None, info: Callable[[str], None], warn: Callable[[str], None]
                 ) -> None:
        """mode: wanted value of packet 35; plus_one: whether the robot reports its mode plus one (create_robot, issue
        64), None: see use(); info(text), warn(text): log a line."""
        self.wanted = mode
        self.is_set = plus_one is not None
        self.plus_one = bool(plus_one)
        self.info = info
        self.warn = warn
        self.reason = ''            # why the robot is not in the wanted mode
        self.restart()

    def use(self, model: protocol.Model) -> None:
        """Supervise a robot of this Model."""
        self.plus_one = self.plus_one or (model.mode_plus_one and not self.is_set)

    @property
    def in_control(self) -> bool:
        """Whether the robot is in the wanted mode."""
        return self.mode == self.wanted

    def forget(self) -> None:
        """Handle a robot that sends no more readings."""
        self.mode: int | None = None            # mode in the last two readings
        self.latest: int | None = None          # mode in the last reading
        self.clear_since: int | None = None     # ns, since when nothing prevents the robot from being driven
        self.attempt: int | None = None         # ns, time of the last request
        self.failures = 0           # consecutive requests that failed without a known cause

    def restart(self) -> None:
        """Handle a Start that is sent to the robot."""
        self.forget()
        self.asked = self.had_control = False       # whether the mode was requested and reached since then

    def mode_in(self, reading: Mapping[str, int]) -> int:
        """Return the mode of a robot with this reading."""
        return min(reading['mode'] - self.plus_one, protocol.FULL)

    def is_passive(self, reading: Mapping[str, int]) -> bool:
        """Return whether a robot is in passive mode."""
        return self.mode_in(reading) == protocol.PASSIVE

    def update(self, now: int, reading: Mapping[str, int], wants_motion: bool, backs: bool = False) -> int | None:
        """Return the mode to request at `now` (ns), or None. wants_motion: whether a motion command is in force; backs:
        whether it is one that a robot in safe mode follows at a cliff.
        """
        reported, before = reading['mode'], self.latest
        self.latest = reported
        if reported != before:      # one reading may be corrupted, so the second one counts
            return None
        self.plus_one = self.plus_one or reported > protocol.FULL   # there is no such mode
        if self.asked:
            self._note(self.mode_in(reading))
        if self.in_control:
            self.clear_since, self.failures = None, 0
            return None
        found, docked = causes(reading), bool(reading['charging_sources'] & protocol.DOCK)
        reasons = list(found)
        if docked:
            reasons.append('on the dock: publish on undock, or lift it off')
        if reasons:
            self.failures = 0
        elif self.failures > ATTEMPTS_BEFORE_LOG:
            reasons.append(f'it reports mode {reported} after it was asked for {protocol.MODE_NAMES[self.wanted]} '
                           f'mode: expected {self.wanted + self.plus_one}, or the parameter oi_mode_workaround: '
                           f'{str(not self.plus_one).lower()}')
        explained, self.reason = self.reason, ', '.join(reasons)
        if self.reason not in ('', explained):
            self.warn(f'The robot cannot be driven: {self.reason}')
        leaves_cliff = backs and found == [CLIFF]
        if (found and not leaves_cliff) or (docked and not wants_motion):
            self.clear_since = None
            return None
        if self.clear_since is None:
            self.clear_since = now
        if (self.had_control and now - self.clear_since < HOLD and not leaves_cliff) or (
                self.attempt is not None and now - self.attempt < RETRY):
            return None
        self.attempt, self.asked = now, True
        self.failures += 1
        return self.wanted

    def _note(self, mode: int) -> None:
        before, self.mode = self.mode, mode
        if mode == self.wanted and before != mode:
            self.had_control, self.reason = True, ''
            self.info(f'The robot is in {protocol.MODE_NAMES[mode]} mode')
        elif before == self.wanted and mode != before:
            self.reason = ''
            self.warn(f'Lost control of the robot: it changed from {protocol.MODE_NAMES[self.wanted]} to '
                      f'{protocol.MODE_NAMES[mode]} mode')


class Contact:
    """Monitors whether the robot answers, and tries to restore contact when it does not."""

    def __init__(self, settings: Settings, sender: Sender, queries: Queries, supervisor: Supervisor,
                 warn: Callable[[str], None]) -> None:
        self.settings = settings
        self.sender = sender
        self.queries = queries
        self.supervisor = supervisor
        self.warn = warn
        self._line: Link            # used unless the phase is NO_LINE
        self.found: Found | None = None         # the robot on this line, kept while it does not answer
        self.dropouts = 0           # number of times that the robot stopped answering
        rates = (settings.baud,) if settings.baud else tuple(dict.fromkeys((*RATES, settings.model.baud)))
        self.search = Search(sender, rates, settings.wake_robot)
        self._flushed = False
        self._attempt = 0           # time of the last attempt to get an answer
        self._refused: Found | None = None      # robot of the wrong type
        self._warned = False        # whether the warning that no robot answers was logged

    def attach(self, now: int, line: Link) -> None:
        """Start using a line that was opened. Sends a stop if the robot is known; otherwise begins the search."""
        self._line = line
        if self.found and line.is_same:
            line.confirm(self.found.model)
            self._begin_asking(now)
        else:
            self._begin_search(now)

    def detach(self) -> None:
        """Handle the loss of the line."""
        self._lose(Phase.NO_LINE)
        self.queries.give_up()

    def tick(self, now: int) -> Found | None:
        """Do what is due. Returns a robot that was just found: use its model, then call start()."""
        phase, heard = self.sender.phase, self.queries.heard
        if phase is Phase.NO_LINE:
            return None
        if phase is Phase.SEARCHING:
            found = self.search.tick(now)
            self._warn_of_silence()
            if found and self._accepts(now, found):
                self._refused, self.found = None, found
                self._line.confirm(found.model)
                return found
        elif phase in ANSWERING:
            if heard is not None and now - heard > SILENCE:
                self._lose(Phase.SILENT)
                self.warn('The robot has stopped responding. If it is still moving, stop it by hand: it keeps '
                          'executing its last command')
                self._begin_asking(now)
        elif phase is Phase.STARTED:
            if now - self._attempt > START_WAIT:
                self._begin_search(now)
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
    def expected(self) -> protocol.Model | None:
        """The only robot that may be driven; None for any."""
        return self.found.model if self.found else protocol.MODELS.get(self.settings.robot_type)

    @property
    def answers(self) -> bool:
        """Whether readings arrive."""
        return self.sender.phase in ANSWERING

    def hear(self) -> bool:
        """Record that a reading has arrived. Returns whether the robot did not answer before."""
        if self.sender.phase not in (Phase.SILENT, Phase.STARTED):
            return False
        self.sender.phase = Phase.WAITING
        return True

    def _lose(self, phase: Phase) -> None:
        self.dropouts += self.answers
        self.sender.phase = phase
        self.supervisor.forget()

    def _begin_asking(self, now: int) -> None:
        self.sender.phase = Phase.SILENT
        self._attempt, self._flushed = now, False
        self._line.set_rate(self.baud)      # another process may have changed it
        self._stop_and_ask(now)

    def _stop_and_ask(self, now: int, stop: bytes = sequences.STOP, kind: Kind = Kind.STOP) -> None:
        self.sender.stop(now, stop, kind)
        self.queries.ask(now)

    def start(self, now: int) -> None:
        """Start the robot that was found."""
        self._attempt, self.sender.phase = now, Phase.SILENT
        self.supervisor.restart()
        self._stop_and_ask(now, sequences.STOP + sequences.START, Kind.START)
        self.sender.phase = Phase.STARTED

    # the search

    def _begin_search(self, now: int) -> None:
        self.sender.phase = Phase.SEARCHING
        self.queries.give_up()
        self.search.begin(now, self._line, self.baud, self.expected)

    def _accepts(self, now: int, found: Found) -> bool:
        """Return whether this robot may be driven; otherwise, the search continues."""
        if self.expected in (None, found.model):
            return True
        assert self.expected
        self.search.begin(now, self._line, found.baud, self.expected)
        if found != self._refused:
            self._refused = found
            self.warn(f'A {found.model.name} answers at {found.baud} baud: expected a {self.expected.name}; to drive '
                      f'it, restart this node with robot_type:={found.model.name}, or auto')
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
