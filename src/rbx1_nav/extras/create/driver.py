"""Driver of a Create: converts commands to bytes, and bytes to odometry, on a clock in ns that the caller passes.

The clock must keep running while the computer is suspended, and must never be set.
"""
from __future__ import annotations

from typing import Callable, Mapping, Sequence

from rbx1_nav.base.command_gate import CommandGate
from rbx1_nav.base.covariances import Reading, Travel
from rbx1_nav.base.schedule import Schedule
from rbx1_nav.base.units import SECOND
from rbx1_nav.extras.create import protocol, sequences
from rbx1_nav.extras.create.refused_commands import OUTAGE, Acceptance
from rbx1_nav.extras.create.analog_gyro import AnalogGyro, Step
from rbx1_nav.extras.create.angle_fractions import Fractions
from rbx1_nav.extras.create.connection import Contact, Supervisor, causes
from rbx1_nav.extras.create.create_parameters import Settings
from rbx1_nav.extras.create.docking import Orders
from rbx1_nav.extras.create.odometry import (
    Counter, CounterTravel, EncoderTravel, Expected, MotionReport, State, unknown)
from rbx1_nav.extras.create.queries import Queries
from rbx1_nav.extras.create.sender import Kind, Phase, Sender, is_too_fast
from rbx1_nav.extras.create.serial_port import Link

INSIST_WAIT = SECOND // 10      # ns without confirmation after which the last stop is repeated
GAP = 3                         # periods without a reading after which one gyro rate no longer represents all of them


class Driver:
    """The state of one robot, which survives the loss of its line."""

    def __init__(self, settings: Settings, gate: CommandGate, info: Callable[[str], None],
                 warn: Callable[[str], None], error: Callable[[str], None]) -> None:
        self.settings = settings
        self.gate = gate
        self.info = info
        self.warn = warn
        self.error = error
        self.sender = Sender()
        self.queries = Queries(self.sender)
        self.supervisor = Supervisor(settings.operation_mode, settings.oi_mode_workaround, info, warn)
        self.contact = Contact(settings, self.sender, self.queries, self.supervisor, warn)
        self.acceptance = Acceptance(settings, gate, self.sender, self.queries, self.supervisor)
        self.orders = Orders(settings, gate, self.sender, self.contact, self.supervisor, info, warn)
        self.schedule = Schedule(settings.update_rate)
        self.due = False            # whether to report the State of the next reading
        # the robot
        self.reading: Mapping[str, int] | None = None   # the last reading
        self.is_new = False         # whether it has arrived since the State was due
        self.gyro_reading: Reading | None = None        # not reported yet
        self.leaving: int | None = None     # ns, when the final stop was requested
        self.has_driven = False     # whether speeds were ever sent
        self.stopped = 0            # ns, when the bytes of the last final stop have left the line
        self.implausible = 0        # readings, for /diagnostics
        self.use(settings.model)

    def use(self, model: protocol.Model) -> None:
        """Drive a robot of this Model. The Model can no longer change after the first reading."""
        self.model = model
        self.supervisor.use(model)
        self.sender.byte = 10 * SECOND // self.contact.baud
        if self.reading is None:
            fractions = Fractions(self.settings.angle_fractions)
            self.counter: Counter = EncoderTravel(model) if model.counts_per_metre else CounterTravel(model, fractions)
            self.motion = MotionReport(self.settings, model, self.counter.rounding)
            has_gyro = model.has_gyro_board and self.settings.has_gyro
            self.gyro = AnalogGyro(self.settings, self.error, self.info) if has_gyro else None
        self.queries.use(model, self.counter)

    # the line

    def attach(self, now: int, line: Link) -> None:
        """Start using a line that was opened: see Contact. Raises OSError."""
        self.sender.use_line(line.write)
        self.contact.attach(now, line)

    def detach(self) -> None:
        """Handle the loss of the line. The robot is out of control: it keeps executing the last command."""
        self.contact.detach()
        self.gate.halt()
        self.sender.use_line(None)

    def stop(self, now: int, reason: str) -> None:
        """Stop the robot, and lock out senders that have not noticed the stop."""
        self.orders.end(now, reason)
        self.acceptance.lock(reason)
        self.sender.stop(now)

    def reset(self) -> None:
        """Stop the robot, and put the odometry back at the origin."""
        self.gate.halt()
        self.motion.reset()

    def leave(self, now: int) -> None:
        """Stop the robot and leave it in passive mode. `left` becomes true once the robot has confirmed this, if it
        can. Raises OSError."""
        self.gate.halt()
        self.leaving = now
        at_rest = self.contact.found is None or (not self.contact.answers and self.motion.stands)
        if self.sender.may_send(Kind.STOP):
            self._leave(now)
        if at_rest:
            self.sender.phase = Phase.LEFT

    def _leave(self, now: int, before: bytes = b'') -> None:
        self.sender.phase = Phase.LEAVING
        self.sender.stop(now, before + sequences.leave(self.model))
        self.stopped = self.sender.line_free

    @property
    def left(self) -> bool:
        """Whether the robot has confirmed the final stop, or cannot move."""
        return self.sender.phase is Phase.LEFT

    # commands

    def command(self, now: int, linear: float, angular: float, others: Sequence[float] = (), sender: str = '') -> bool:
        """Put a command in force, and send it at once; for arguments, result and errors see CommandGate.command().

        sender: the name of the node that sent it. Raises RefusedCommand if the robot does not follow the command now.
        """
        if self.leaving is not None:
            return False
        self.acceptance.notice_stall(now)
        self.acceptance.check_sender(now, sender, bool(linear or angular))
        self.orders.end(now, f'a command from {sender}')
        try:
            clamped = self.gate.command(now, linear, angular, others)
        finally:
            self._send_speeds(now)
        self.acceptance.check_obedience(now)
        too_fast = is_too_fast(self.gate.linear, self.gate.angular, self.model.wheel_separation)
        self.gate.clamped += too_fast and not clamped
        return clamped or too_fast

    def _must_stop(self) -> bool:
        return any(self.sender.speeds) and not any(self.acceptance.speeds(self.model))

    def _send_speeds(self, now: int) -> None:
        if not self.sender.is_busy(now) or self._must_stop():
            self.sender.drive(now, self.acceptance.speeds(self.model))
            if any(self.sender.speeds):
                self.motion.command(now)
                self.has_driven = True

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
        if self.sender.phase in (Phase.LEAVING, Phase.LEFT):
            if not self.left and now - self.stopped > INSIST_WAIT:
                self._leave(now, sequences.FLUSH)       # completes whatever may have swallowed the previous stop
            if not self.queries.awaits_reply(now):
                self.queries.ask(now)
            return False
        answered, found = self.contact.answers, self.contact.tick(now)
        if answered and not self.contact.answers:
            self.gate.halt()
        if found:
            self.use(found.model)
            self.contact.start(now)
            if self.leaving is not None:    # the Start bytes of the search have stopped any motion
                self._leave(now)
        if self.leaving is not None:
            return False
        self.acceptance.notice_losses()
        due = self.schedule.due(now)
        if due and not self.due:
            self.due, self.is_new = True, False
        if due or self._must_stop():
            self._send_speeds(now)
        if (due or self.queries.waiting) and not self.queries.awaits_reply(now):
            self.queries.ask(now)
        return timed_out

    def until_tick(self, now: int) -> float:
        """Return the time (s) until tick() has something to do."""
        return max(0, self.schedule.next - now) / SECOND

    @property
    def missing(self) -> int | None:
        """The number of bytes that complete the data that is due now; None before the next tick."""
        if self.sender.phase is Phase.SEARCHING:
            return self.contact.search.missing
        waits = self.due or self.leaving is not None
        return self.queries.missing if waits else None

    # readings

    def receive(self, now: int, data: bytes) -> None:
        if self.sender.phase is Phase.SEARCHING:
            self.contact.search.receive(now, data)
            return
        reading = self.queries.receive(now, data)
        if reading:
            self._accept(now, reading)

    def _accept(self, now: int, reading: Mapping[str, int]) -> None:
        queries = self.queries
        if queries.probes and not self.counter.fits(reading, *queries.since_reading(), 0.0):
            queries.sensed_at(now)
        time = queries.asked.time
        elapsed, expected = queries.since_reading()
        # a robot that was just switched on and started is in passive mode, and counts from 0
        reset = (self.sender.phase is Phase.STARTED and self.reading is not None
                 and self.supervisor.is_passive(reading) and self.counter.is_reset(reading))
        if reset:
            self.counter.restart()
        travel = self.counter.update(reading, elapsed, expected, queries.lost_share)
        if travel is None:
            self.implausible += 1
            queries.lose_reply()
            return
        if reset:
            travel = unknown(expected, self.model.wheel_separation)
        if self.contact.hear():
            self._recover(0 if queries.heard is None else now - queries.heard, reset)
        queries.accept(now)
        self.reading, self.is_new = reading, True
        self.acceptance.follow(elapsed, expected, travel, self.model.wheel_separation)
        travel = self.motion.add(time, travel)
        if self.gyro:
            step = self._step(elapsed, travel, expected, reading)
            self.gyro_reading = self.gyro.update(reading['analog_input'], step)
        if self.leaving is None:
            self._supervise(time, reading)
        elif time >= self.leaving and (self.supervisor.is_passive(reading) or not self.has_driven):
            if self.orders.confirms_end():
                self.sender.phase = Phase.LEFT
            else:
                self._leave(now)

    def _step(self, elapsed: float, travel: Travel, expected: Expected, reading: Mapping[str, int]) -> Step:
        """Return the Step for the gyro. expected: travel according to the commands."""
        bits = reading['bumps_and_wheel_drops']
        _, variance = self.settings.errors.variances(travel.distance, travel.angle)
        variance = travel.angle_variance + variance + self.counter.rounding[1] ** 2
        return Step(elapsed, travel.angle, variance, (expected.right - expected.left) / self.model.wheel_separation,
                    self.motion.stands and not bits & protocol.WHEEL_DROPS,      # a lifted robot may be turned by hand
                    self.sender.phase is Phase.DRIVEN, bool(bits),
                    elapsed * self.settings.update_rate > GAP)

    def _supervise(self, time: int, reading: Mapping[str, int]) -> None:
        if self.orders.update(time, reading, (self.motion.left + self.motion.right) / 2):
            return
        before = self.supervisor.in_control
        if (mode := self.supervisor.update(time, reading, self.gate.moving, self.acceptance.backs)) is not None:
            self.sender.send(time, Kind.MODE, sequences.take_control(self.model, mode))
        is_driven = self.supervisor.in_control and self.settings.operation_mode != protocol.PASSIVE
        self.sender.phase = Phase.DRIVEN if is_driven else Phase.WAITING
        if self.acceptance.feel(reading) or (before and not self.supervisor.in_control):
            self.acceptance.lock(', '.join(causes(reading)) or 'the robot left the mode in which it is driven')

    def _recover(self, silence: int, reset: bool) -> None:
        """Log that the robot answers, and lock if it did not for too long (ns)."""
        if self.reading is None:
            self.info(f'Connected to a {self.model.name} at {self.contact.baud} baud')
            return
        what = ('was switched off, reset, or silent at rest' if reset else
                f'did not answer for {silence / SECOND:.1f} s')
        self.warn(f'The robot answers again: it {what}')
        if reset or silence > OUTAGE:
            self.acceptance.lock(f'the robot {what}')

    def state(self) -> State | None:
        """Return the State if one is due and there is a new reading for it; else None."""
        if not (self.contact.answers and self.due and self.is_new):
            return None
        self.due = False
        gyro, self.gyro_reading = self.gyro_reading, None
        return self.motion.state(gyro, self.counter.unread_variance)
