"""Drives a Create: commands to bytes, bytes to odometry, on a clock in ns that the caller passes.

The clock must go on while the computer is suspended, and must never be set.
"""
from math import copysign

from rbx1_nav.create import protocol, sequences
from rbx1_nav.create.commanded import Commanded
from rbx1_nav.create.gyro import AnalogGyro
from rbx1_nav.create.motion import Motion
from rbx1_nav.create.speeds import Rounding, is_too_fast, wheel_speeds
from rbx1_nav.create.stream import FrameReader, ReplyReader
from rbx1_nav.create.supervisor import BUMPS, WHEEL_DROPS, Supervisor
from rbx1_nav.create.travel import Implausible, travel_of, unknown
from rbx1_nav.schedule import Schedule
from rbx1_nav.units import SECOND

SILENCE = SECOND // 2       # ns without a reading: the robot does not answer
FIRST_WAIT = 3 * SECOND // 10   # ns that a robot that is on may need to answer, before it is started
START_WAIT = SECOND         # ns between two attempts to start it
PATIENCE = 3                # attempts before the first warning
REPLY_TIMEOUT = SECOND // 5     # ns from a query to the first byte of its reply
BYTE_TIMEOUT = SECOND // 20     # ns between two bytes of a reply
BACKLOG = SECOND // 100     # ns that the line may be busy with earlier bytes: then only a stop is sent at once


class Driver:
    """The state of one robot, whatever happens to its line."""

    def __init__(self, settings, gate, info, warn):
        """settings: Settings; gate: a CommandGate; info(text), warn(text): log a line."""
        self.settings = settings
        self.gate = gate
        self.info = info
        self.warn = warn
        model = self.model = settings.model
        self.byte = 10 * SECOND // model.baud   # ns
        self.polled = model is protocol.CREATE
        self.reader = ReplyReader(model, sequences.QUERIED) if self.polled else FrameReader(model, sequences.STREAMED)
        self.counter = travel_of(model)
        self.motion = Motion(settings, self.counter.rounding)
        self.gyro = AnalogGyro(settings.gyro_range, settings.gyro_correction) if settings.has_gyro else None
        self.supervisor = Supervisor(settings.mode, info, warn)
        self.schedule = Schedule(settings.update_rate)
        self.due = None             # ns: a State of a reading that arrives after this is to be reported
        # the line
        self.write = None           # sends bytes; None without a line
        self.error = None           # the OSError with which the line was lost
        self.line_free = 0          # ns, when all bytes are on their way
        self.byte_time = 0          # ns, when the last bytes arrived
        # the robot
        self.answers = False        # whether readings arrive
        self.started = False        # whether the robot was started since it last answered
        self.starts = 0             # attempts before it answered for the first time
        self.attempt = None         # ns, of the last attempt
        self.reading = None         # the last one
        self.reading_time = None    # ns, when the robot made it
        self.received = None        # ns, when it arrived
        self.gyro_reading = None    # a Reading that was not reported yet
        # the wheels
        self.commanded = Commanded()
        self.rounding = Rounding(), Rounding()
        self.sent_time = 0          # ns
        # what /diagnostics counts
        self.saturated = 0          # commands
        self.implausible = 0        # readings
        self.missed = 0             # replies
        self.dropouts = 0           # times that the robot fell silent

    # the line

    def attach(self, now, write):
        """A line was opened. write(bytes): may raise OSError. The first bytes on it are a stop."""
        self.write, self.error = write, None
        self.answers = self.started = False
        self.attempt = now
        self.reader.clear()
        self._stop(now)
        self._ask(now, sequences.ask(self.model))

    def detach(self, now):
        """The line is lost, and with it the control of the robot, which goes on with the last command."""
        if self.answers:
            self._lose_robot()
        self.gate.halt()
        self.commanded.advance(now)
        self.write = None
        self._miss()

    def stop(self, now):
        """Stop the robot, until the next command."""
        self.gate.halt()
        self._stop(now)

    def leave(self, now):
        """Stop the robot, and leave it in passive mode."""
        self.gate.halt()
        self.commanded.send(now, (0, 0))
        self._write(now, sequences.leave(self.model))

    def _stop(self, now):
        self.commanded.send(now, (0, 0))
        for rounding in self.rounding:
            rounding.reset()
        self._write(now, sequences.STOP)

    def _write(self, now, data):
        if self.write is None:
            return
        self.line_free = max(now, self.line_free) + len(data) * self.byte
        try:
            self.write(data)
        except OSError as error:
            self.write, self.error = None, error

    # queries

    def _ask(self, now, data):
        """Send bytes that ask for a reading."""
        self._miss()
        if self.polled:
            self.reader.expect()
            self.commanded.ask(now)
        self._write(now, data)

    def _miss(self):
        """A query that is not answered costs the travel before it, if it arrived."""
        if self.polled and self.reader.waiting:
            self._lose_reply(bool(self.reader.buffer))
            self.reader.clear()

    def _lose_reply(self, begun):
        """begun: whether a part of the reply arrived."""
        commanded = self.commanded
        self.missed += 1
        self.counter.miss(begun, (commanded.asked_time - commanded.counted_from) / SECOND, commanded.asked)
        commanded.start(commanded.asked_time, commanded.asked)

    def _awaits_reply(self, now):
        if not self.reader.waiting:
            return False
        return (now - self.byte_time < BYTE_TIMEOUT if self.reader.buffer
                else now - self.commanded.asked_time < REPLY_TIMEOUT)

    # commands

    def command(self, now, linear, angular, others=()):
        """Put a command in force, and send it at once; arguments, result and errors as of CommandGate.command()."""
        try:
            return self.gate.command(now, linear, angular, others)
        finally:
            self.saturated += is_too_fast(self.gate.linear, self.gate.angular, self.model.wheel_separation)
            self._send_speeds(now)

    def _allowed(self):
        """(left, right) in mm/s that the robot may go now."""
        linear, angular = self.gate.linear, self.gate.angular
        if not (self.answers and self.supervisor.in_control) or self.settings.mode == protocol.PASSIVE:
            return 0.0, 0.0
        if angular:
            angular = copysign(max(abs(angular), self.settings.min_yaw_speed), angular)
        bits = self.reading['bumps_and_wheel_drops']
        if bits & WHEEL_DROPS or linear > 0 and self.settings.stop_on_bump and bits & BUMPS:
            return 0.0, 0.0
        return wheel_speeds(linear, angular, self.model.wheel_separation)

    def _must_stop(self):
        return self.commanded.moving and not any(self._allowed())

    def _send_speeds(self, now):
        if self.write is None or self.line_free - now > BACKLOG and not self._must_stop():
            return
        elapsed, self.sent_time = (now - self.sent_time) / SECOND, now
        left, right = (rounding.next(speed, elapsed) for rounding, speed in zip(self.rounding, self._allowed()))
        self.commanded.send(now, (left, right))
        if self.commanded.moving:
            self.motion.command(now)
        self._write(now, protocol.drive_direct(right, left))

    # time

    def tick(self, now):
        """Do what is due: to be called after each receive(), and at least at the update rate. Returns whether the
        command in force has timed out."""
        gate = self.gate
        timed_out = gate.moving and now >= gate.expiry
        if timed_out:
            gate.halt()
        if self.answers and now - self.reading_time > SILENCE:
            self._fall_silent(now)
        if self.write and not self.answers and now - self.attempt > (START_WAIT if self.started else FIRST_WAIT):
            self._start(now)
        due = self.schedule.due(now)
        if due and self.due is None:
            self.due = now
        if due or self._must_stop():
            self._send_speeds(now)
        if due and self.polled and self.write and not self._awaits_reply(now):
            self._ask(now, sequences.QUERY)
        return timed_out

    def until_tick(self, now):
        """How long it is until tick() has something to do, s."""
        return max(0, self.schedule.next - now) / SECOND

    @property
    def awaited(self):
        """The reader of the reading that is due now; None before the next tick."""
        return None if self.due is None else self.reader

    def _lose_robot(self):
        self.answers = False
        self.dropouts += 1
        self.supervisor.forget()

    def _fall_silent(self, now):
        self._lose_robot()
        self.gate.halt()
        self.attempt, self.started = now, False
        self.warn('The robot no longer answers. If it still moves, it goes on with its last command: stop it by hand')
        self._stop(now)
        self._ask(now, sequences.ask(self.model))

    def _start(self, now):
        if self.reading is None:
            self.starts += 1
            if self.starts == PATIENCE:
                self._warn_of_silence()
        self.attempt, self.started = now, True
        self._stop(now)
        self._ask(now, sequences.start(self.model))

    def _warn_of_silence(self):
        rates = ', '.join('%s: %d baud' % (name, model.baud) for name, model in protocol.MODELS.items())
        self.warn('The robot does not answer: expected a %s that is switched on, at the other end of the cable '
                  '(robot_type %s)' % (self.model.name, rates))

    # readings

    def receive(self, now, data):
        """Process bytes of the robot."""
        if data:
            self.byte_time = now
        rejected = self.reader.rejected
        for reading in self.reader.feed(data):
            # the robot made a frame before it was on the line, and a reply when it received the query
            time = self.commanded.asked_time if self.polled else now - len(data) * self.byte
            self.commanded.advance(now)
            self.received = now
            self._accept(max(time, self.reading_time or 0), reading)
        if self.polled and self.reader.rejected != rejected:
            self._lose_reply(True)

    def _accept(self, time, reading):
        commanded = self.commanded
        elapsed = (time - self.reading_time) / SECOND if self.reading else 0.0
        part = commanded.asked if self.polled else commanded.counted
        # a robot that was just switched on is in passive mode, since it was started, and counts from 0
        reset = not self.answers and self.started and self.reading and (
            reading['mode'] == protocol.PASSIVE and self.counter.is_new(reading))
        if reset:
            self.counter.restart()
        try:
            travel = self.counter.update(reading, elapsed, part)
        except Implausible:
            self.implausible += 1
            if self.polled:
                self._lose_reply(True)
            return
        if reset:
            travel = unknown(commanded.since_reading, self.model.wheel_separation)
        if not self.answers:
            self._recover(elapsed, reset)
        commanded.start(time, part)
        commanded.read()
        self.reading, self.reading_time = reading, time
        self.motion.add(time, travel)
        if self.gyro:
            turn = travel.angle, travel.angle_variance + self.counter.rounding[1] ** 2
            self.gyro_reading = self.gyro.update(reading['analog_input'], elapsed, self.motion.stands,
                                                 turn if elapsed > SILENCE / SECOND else None)
        self._supervise(time, reading)

    def _supervise(self, time, reading):
        before = self.supervisor.in_control
        if self.supervisor.update(time, reading, self.gate.moving):
            self._write(time, sequences.take_control(self.model, self.settings.mode))
        if before and not self.supervisor.in_control:
            self.gate.halt()

    def _recover(self, elapsed, reset):
        self.answers, self.started = True, False
        if self.reading is None:
            self.info('The robot answers: %s' % self.model.name)
        else:
            self.warn('The robot answers again, after %.1f s%s'
                      % (elapsed, ': it was switched off or reset' if reset else ''))

    def state(self):
        """The State, if one is due and there is a new reading for it; else None."""
        if not self.answers or self.due is None or self.received <= self.due or not self.motion.is_new:
            return None
        self.due = None
        gyro, self.gyro_reading = self.gyro_reading, None
        return self.motion.state(gyro)
