"""Driver of a Create: converts commands to bytes, and bytes to odometry, on a clock in ns that the caller passes.

The clock must keep running while the computer is suspended, and must never be set.
"""
from __future__ import annotations

from typing import Callable, Mapping, Sequence

from rbx1_nav.control.gate import CommandGate
from rbx1_nav.create import protocol
from rbx1_nav.create.driver import sequences
from rbx1_nav.create.driver.acceptance import OUTAGE, Acceptance
from rbx1_nav.create.driver.analog_gyro import AnalogGyro
from rbx1_nav.create.driver.contact import Contact, Event
from rbx1_nav.create.driver.fractions import Fractions
from rbx1_nav.create.driver.gyro_check import Step
from rbx1_nav.create.driver.motion_report import MotionReport, State
from rbx1_nav.create.driver.parameters import Settings
from rbx1_nav.create.driver.queries import Queries
from rbx1_nav.create.driver.replies import ReplyReader
from rbx1_nav.create.driver.search import Line, Search
from rbx1_nav.create.driver.sender import Sender
from rbx1_nav.create.driver.speeds import is_too_fast
from rbx1_nav.create.driver.supervisor import WHEEL_DROPS, Supervisor, causes
from rbx1_nav.create.driver.travel import Expected, Implausible, Travel, travel_of, unknown
from rbx1_nav.robot.readings import Reading
from rbx1_nav.schedule import Schedule
from rbx1_nav.units import SECOND

INSIST_WAIT = SECOND // 10      # ns without confirmation after which the last stop is repeated
GAP = 3                         # periods without a reading after which one gyro rate no longer represents all of them


class Driver:
    """The state of one robot, which survives the loss of its line."""

    def __init__(self, settings: Settings, gate: CommandGate, info: Callable[[str], None],
                 warn: Callable[[str], None], error: Callable[[str], None]) -> None:
        """info, warn, error: log a line."""
        self.settings = settings
        self.gate = gate
        self.info = info
        self.warn = warn
        self.error = error
        self.sender = Sender()
        self.commanded = self.sender.commanded
        self.queries = Queries(self.sender)
        self.supervisor = Supervisor(settings.mode, settings.mode_plus_one, info, warn)
        self.contact = Contact(settings, self.sender, self.queries, self.supervisor, warn)
        self.acceptance = Acceptance(settings, gate, self.contact, self.supervisor)
        self.schedule = Schedule(settings.update_rate)
        self.due: int | None = None     # ns: report the State of the first reading that arrives after this
        # the robot
        self.reading: Mapping[str, int] | None = None   # the last reading
        self.reading_time: int | None = None            # ns, when the robot made it
        self.received = 0           # ns, when it arrived
        self.gyro_reading: Reading | None = None        # not reported yet
        self.leaving: int | None = None     # ns, when the final stop was requested
        self.left = False           # whether the robot has confirmed the final stop
        self.told = 0               # ns, when the final stop was last sent
        self.saturated = 0          # commands, for /diagnostics
        self.implausible = 0        # readings, for /diagnostics
        self.use(settings.model)

    def use(self, model: protocol.Model) -> None:
        """Drive a robot of this Model. The Model can no longer change after the first reading."""
        self.model = model
        self.baud = (self.contact.found or model).baud
        self.sender.byte = 10 * SECOND // self.baud
        if self.reading is None:
            self.counter = travel_of(model, Fractions(self.settings.angle_fractions, self.warn))
            self.motion = MotionReport(self.settings, model, self.counter.rounding)
            self.gyro = (AnalogGyro(self.settings.gyro_range, self.settings.gyro_correction, self.error, self.info)
                         if model is protocol.CREATE and self.settings.has_gyro else None)
        self.queries.use(model, self.counter)

    # the line

    def attach(self, now: int, line: Line) -> None:
        """Start using a line that was opened: see Contact. Raises OSError."""
        self.sender.open(line.write)
        self.contact.attach(now, line)

    def detach(self) -> None:
        """Handle the loss of the line. The robot is out of control: it keeps executing the last command."""
        self.contact.detach()
        self.acceptance.lose_robot()
        self.sender.close()

    def stop(self, now: int, reason: str) -> None:
        """Stop the robot, and lock out senders that have not noticed the stop."""
        self.acceptance.lock(reason)
        if self.contact.may_ask:
            self.sender.stop(now)

    def restore(self, now: int) -> None:
        """Stop anything that the robot may have started when another process changed the settings of the port."""
        if self.leaving is None and self.contact.may_ask:
            mode = (sequences.take_control(self.model, self.settings.mode) if self.supervisor.in_control
                    else sequences.START)
            self.sender.stop(now, after=sequences.STOP + mode)

    def leave(self, now: int) -> None:
        """Stop the robot and leave it in passive mode. `left` becomes true once the robot has confirmed this, if it
        can. Raises OSError."""
        self.gate.halt()
        if not self.contact.found:      # nothing that moves the robot was sent
            self.left = True
            return
        self.leaving = self.told = now
        self.left = not self.contact.answers and self.motion.stands
        if self.contact.may_ask:
            self._leave(now)

    def _leave(self, now: int, before: bytes = b'') -> None:
        self.told = now + len(before) * self.sender.byte
        self.sender.stop(now, before, sequences.leave(self.model))
        self.queries.ask(now)

    def _insist(self, now: int) -> None:
        """Repeat the final stop, after bytes that complete whatever may have swallowed the previous one."""
        if not self.left and now - self.told > INSIST_WAIT:
            self._leave(now, sequences.FLUSH)

    # commands

    def command(self, now: int, linear: float, angular: float, others: Sequence[float] = (), sender: str = '') -> bool:
        """Put a command in force, and send it at once; for arguments, result and errors see CommandGate.command().

        sender: the name of the node that sent it. Raises RefusedCommand if the robot does not follow the command now.
        """
        self.acceptance.notice_stall(now)
        self.acceptance.check_sender(now, sender, bool(linear or angular))
        try:
            clamped = self.gate.command(now, linear, angular, others)
        finally:
            self.saturated += is_too_fast(self.gate.linear, self.gate.angular, self.model.wheel_separation)
            self._send_speeds(now)
        self.acceptance.check_obedience(now)
        return clamped

    def _must_stop(self) -> bool:
        return self.commanded.moving and not any(self.acceptance.speeds(self.model))

    def _send_speeds(self, now: int) -> None:
        if self.contact.may_ask and (not self.sender.is_busy(now) or self._must_stop()):
            self.sender.drive(now, self.acceptance.speeds(self.model))
            if self.commanded.moving:
                self.motion.command(now)

    @property
    def is_ready(self) -> bool:
        """Whether a robot has answered, and either can be driven or has a known reason why not."""
        return self.reading is not None and bool(self.supervisor.in_control or self.supervisor.reason)

    # time

    def tick(self, now: int) -> bool:
        """Do what is due. Call it after each receive(), and at least at the update rate. Returns whether the command in
        force has timed out. Raises OSError."""
        timed_out = self.gate.moving and now >= self.gate.expiry
        self.acceptance.notice_stall(now)
        if timed_out:
            self.gate.halt()
        if self.leaving is not None and not self.contact.searching:     # the Start bytes of the search stop any motion
            self._insist(now)
            return False
        event = self.contact.tick(now, self.reading_time)
        if event is Event.LOST:
            self.acceptance.lose_robot()
        elif event is Event.FOUND and self.contact.found:
            self.use(self.contact.found.model)
            self.contact.start(now)
        if self.leaving is not None:
            return False
        self.acceptance.notice_losses(self.counter.bad)
        due = self.schedule.due(now)
        self.due = now if due and self.due is None else self.due
        if due or self._must_stop():
            self._send_speeds(now)
        if self.contact.may_ask and (due or self.counter.hurries) and not self.queries.awaits_reply(now):
            self.queries.ask(now)
        return timed_out

    def until_tick(self, now: int) -> float:
        """Return the time (s) until tick() has something to do."""
        time = self.schedule.next
        if self.contact.searching:
            time = min(time, self.contact.search.next_time)
        return max(0, time - now) / SECOND

    @property
    def awaited(self) -> Search | ReplyReader | None:
        """The reader for the data that is due now; None before the next tick."""
        if self.contact.searching:
            return self.contact.search
        return None if self.due is None and self.leaving is None and not self.counter.hurries else self.queries.reader

    # readings

    def receive(self, now: int, data: bytes) -> None:
        """Process bytes from the robot."""
        if self.contact.searching:
            self.contact.receive(now, data)
            return
        reading = self.queries.receive(now, data)
        if reading:
            self.commanded.advance(now)
            self.received = now
            self._accept(reading)

    def _accept(self, reading: Mapping[str, int]) -> None:
        commanded = self.commanded
        time, part = commanded.asked_time, commanded.asked      # the robot senses when it receives the query
        elapsed = (time - self.reading_time) / SECOND if self.reading_time is not None else 0.0
        # a robot that was just switched on and started is in passive mode, and counts from 0
        reset = (self.contact.started and self.reading is not None
                 and self.supervisor.is_passive(reading) and self.counter.is_reset(reading))
        if reset:
            self.counter.restart()
        try:
            travel = self.counter.update(reading, elapsed, part)
        except Implausible:
            self.implausible += 1
            self.queries.lose_reply(True)
            return
        if reset:
            travel = unknown(commanded.since_reading, self.model.wheel_separation)
        if self.contact.hear():
            self._recover(elapsed, reset)
        commanded.start(time, part)
        commanded.read()
        self.reading, self.reading_time = reading, time
        self.acceptance.follow(elapsed, part, travel, self.model.wheel_separation)
        travel = self.motion.add(time, travel)
        if self.gyro:
            self.gyro_reading = self.gyro.update(reading['analog_input'], self._step(elapsed, travel, part, reading))
        if self.leaving is None:
            self._supervise(time, reading)
        elif time >= self.leaving and self.supervisor.is_passive(reading):
            self.left = True

    def _step(self, elapsed: float, travel: Travel, expected: Expected, reading: Mapping[str, int]) -> Step:
        """Return the Step for the gyro. expected: travel according to the commands."""
        bits = reading['bumps_and_wheel_drops']
        variance = travel.angle_variance + self.settings.errors.variances(travel)[1] + self.counter.rounding[1] ** 2
        return Step(elapsed, travel.angle, variance, (expected.right - expected.left) / self.model.wheel_separation,
                    self.motion.stands and not bits & WHEEL_DROPS,      # a lifted robot may be turned by hand
                    self.supervisor.in_control and self.settings.mode != protocol.PASSIVE, bool(bits),
                    elapsed * self.settings.update_rate > GAP)

    def _supervise(self, time: int, reading: Mapping[str, int]) -> None:
        before = self.supervisor.in_control
        if (mode := self.supervisor.update(time, reading, self.gate.moving, self.acceptance.backs)) is not None:
            self.sender.send(time, sequences.take_control(self.model, mode))
        if self.acceptance.feel(time, reading) or (before and not self.supervisor.in_control):
            self.acceptance.lock(', '.join(causes(reading)) or 'the robot left the mode in which it is driven')

    def _recover(self, elapsed: float, reset: bool) -> None:
        if self.reading is None:
            self.info(f'The robot answers: {self.model.name} at {self.baud} baud')
            return
        what = 'the robot was switched off or reset' if reset else f'the robot did not answer for {elapsed:.1f} s'
        self.warn(f"The robot answers again, after {elapsed:.1f} s{': it was switched off or reset' if reset else ''}")
        if reset or elapsed > OUTAGE / SECOND:
            self.acceptance.lock(what)

    def state(self) -> State | None:
        """Return the State if one is due and there is a new reading for it; else None."""
        if not self.contact.answers or self.due is None or self.received <= self.due or not self.motion.is_new:
            return None
        self.due = None
        gyro, self.gyro_reading = self.gyro_reading, None
        return self.motion.state(gyro, self.counter.unread_variance)
