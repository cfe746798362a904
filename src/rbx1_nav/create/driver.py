"""Drives a Create: commands to bytes, bytes to odometry, on a clock in ns that the caller passes.

The clock must go on while the computer is suspended, and must never be set.
"""
from collections import namedtuple
from math import copysign

from rbx1_nav.create import protocol, sequences
from rbx1_nav.create.gyro import AnalogGyro
from rbx1_nav.create.odometry import UncertainOdometry
from rbx1_nav.create.speeds import Rounding, is_too_fast, wheel_speeds
from rbx1_nav.create.stream import FrameReader, ReplyReader
from rbx1_nav.create.supervisor import BUMPS, WHEEL_DROPS, Supervisor
from rbx1_nav.create.travel import NOWHERE, STILL, Expected, Implausible, Travel, travel_of
from rbx1_nav.model.wheels import MEASURED
from rbx1_nav.schedule import Schedule
from rbx1_nav.units import SECOND

SILENCE = SECOND // 2       # ns without a reading: the robot does not answer
FIRST_WAIT = 3 * SECOND // 10   # ns that a robot that is on may need to answer, before it is started
START_WAIT = SECOND         # ns between two attempts to start it
REPLY_TIMEOUT = SECOND // 5     # ns from a query to the first byte of its reply
BYTE_TIMEOUT = SECOND // 20     # ns between two bytes of a reply
BACKLOG = SECOND // 100     # ns that the line may be busy with earlier bytes: then only a stop is sent at once
PATIENCE = 3                # attempts to start it before the first warning
STANDSTILL = SECOND // 2    # ns without travel: the robot stands

State = namedtuple('State', 'time pose covariance velocity variances travel gyro')
State.__doc__ = """What the base reports. time: ns, of the last reading; pose: Pose; covariance: 3x3; velocity: m/s and
rad/s, the mean since the last State; variances: of these; travel: of both wheels, m; gyro: Reading or None."""


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
        self.odometry = UncertainOdometry(model.wheel_separation, settings.linear_error, settings.angular_error,
                                          self.counter.rounding)
        self.gyro = AnalogGyro(settings.gyro_range, settings.gyro_correction) if settings.has_gyro else None
        self.supervisor = Supervisor(settings.mode, info, warn)
        self.schedule = Schedule(settings.update_rate)
        self.write = None           # sends bytes; None without a line
        self.error = None           # the OSError with which the line was lost
        self.answers = False        # whether readings arrive
        self.starts = 0             # attempts before it answered for the first time
        self.started = False        # whether the robot was started since it last answered
        self.reading = None         # the last one
        self.reading_time = None    # ns, when the robot made it
        self.attempt = None         # ns, of the last attempt to get an answer
        self.query_time = None      # ns
        self.byte_time = 0          # ns, when the last bytes arrived
        self.sent = (0, 0)          # left, right: mm/s
        self.sent_time = 0          # ns
        self.line_free = 0          # ns, when all bytes are on their way
        self.integrated = 0         # ns, up to where `expected` goes
        self.rounding = Rounding(), Rounding()
        self.expected = STILL       # by the commands since the robot last started to count
        self.queried = STILL        # the part of it before the last query
        self.counted_from = 0       # ns, when the robot last started to count
        self.left = self.right = 0.0    # m, total travel of the wheels
        self.moved_time = None      # ns, of the last travel or command to move
        self.reported = None        # ns, time of the last State
        self.state_due = False      # whether it is time for another one
        self.since = NOWHERE        # Travel since then
        self.last_gyro = None       # the last Reading
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
        self._ask(now)

    def detach(self, now):
        """The line is lost, and with it the control of the robot, which goes on with the last command."""
        if self.answers:
            self.dropouts += 1
        self._integrate(now)
        self.write = None
        self.answers = False
        self.gate.halt()
        self.supervisor.forget()
        self._miss(now)

    def stop(self, now):
        """Stop the robot, until the next command."""
        self.gate.halt()
        self._stop(now)

    def leave(self, now):
        """Stop the robot, and leave it in passive mode."""
        self.gate.halt()
        self._integrate(now)
        self.sent = (0, 0)
        self._write(now, sequences.leave(self.model))

    def _write(self, now, data):
        if self.write is None:
            return
        self.line_free = max(now, self.line_free) + len(data) * self.byte
        try:
            self.write(data)
        except OSError as error:
            self.write, self.error = None, error

    def _stop(self, now):
        self._integrate(now)
        self.sent = (0, 0)
        for rounding in self.rounding:
            rounding.reset()
        self._write(now, sequences.STOP)

    def _ask(self, now):
        """Ask for a reading. A query that was not answered may have cost travel."""
        self._miss(now)
        if self.polled:
            self.reader.expect()
            self.query_time, self.queried = now, self.expected
        self._write(now, sequences.ask(self.model))

    def _miss(self, now):
        if self.polled and self.reader.waiting:
            self._lose(bool(self.reader.buffer))
            self.reader.clear()

    def _lose(self, begun):
        """The reply to the last query is lost. begun: whether a part of it arrived."""
        self.missed += 1
        self.counter.miss(begun, (self.query_time - self.counted_from) / SECOND, self.queried)
        self._count_from(self.query_time, self.queried)

    def _count_from(self, time, read):
        self.expected = Expected(*(total - part for total, part in zip(self.expected, read)))
        self.counted_from = time

    def _integrate(self, now):
        """Add up what the command on the line should have moved until now."""
        elapsed = max(0, now - self.integrated) / SECOND / 1000
        self.expected = Expected(*(total + speed * elapsed for total, speed in zip(self.expected, self.sent)))
        self.integrated = now

    # commands

    def command(self, now, linear, angular, others=()):
        """Put a command in force, and send it at once; arguments, result and errors as of CommandGate.command()."""
        try:
            return self.gate.command(now, linear, angular, others)
        finally:
            self.saturated += is_too_fast(self.gate.linear, self.gate.angular, self.model.wheel_separation)
            self._send_speeds(now)

    def _asked(self):
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

    def _send_speeds(self, now):
        asked = self._asked()
        if self.write is None or self.line_free - now > BACKLOG and (any(asked) or not any(self.sent)):
            return
        elapsed, self.sent_time = (now - self.sent_time) / SECOND, now
        self._integrate(now)
        self.sent = tuple(rounding.next(speed, elapsed) for rounding, speed in zip(self.rounding, asked))
        if any(self.sent):
            self.moved_time = now
        left, right = self.sent
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
        self.state_due = self.state_due or due
        if due or timed_out or (any(self.sent) and not any(self._asked())):
            self._send_speeds(now)
        if due and self.polled and self.write and not self._awaits_reply(now):
            self._ask(now)
        return timed_out

    def until_tick(self, now):
        """How long it is until tick() has something to do, s."""
        return max(0, self.schedule.next - now) / SECOND

    def _awaits_reply(self, now):
        if not self.reader.waiting:
            return False
        return now - self.byte_time < BYTE_TIMEOUT if self.reader.buffer else now - self.query_time < REPLY_TIMEOUT

    def _fall_silent(self, now):
        self.answers = False
        self.dropouts += 1
        self.attempt, self.started = now, False
        self.gate.halt()
        self.supervisor.forget()
        self._warn_of_silence()
        self._stop(now)
        self._write(now, b'' if self.polled else sequences.ask(self.model))

    def _warn_of_silence(self):
        self.warn('The robot does not answer: expected a %s that is switched on, at the other end of the cable'
                  % self.model.name)

    def _start(self, now):
        if self.reading is None:
            self.starts += 1
            if self.starts == PATIENCE:
                self._warn_of_silence()
        self.started = True
        self.attempt = now
        self._miss(now)
        self._stop(now)
        if self.polled:
            self.reader.expect()
            self.query_time, self.queried = now, self.expected
        self._write(now, sequences.start(self.model))

    # readings

    def receive(self, now, data):
        """Process bytes of the robot."""
        rejected = self.reader.rejected
        if data:
            self.byte_time = now
        for reading in self.reader.feed(data):
            # the robot made a frame before it was on the line, and a reply when it received the query
            time = self.query_time if self.polled else now - len(data) * self.byte
            self._integrate(now)
            self._accept(max(time, self.reading_time or 0), reading)
        if self.polled and self.reader.rejected != rejected:
            self._lose(True)

    def _accept(self, time, reading):
        gap = not self.answers
        elapsed = (time - self.reading_time) / SECOND if self.reading else 0.0
        read = self.queried if self.polled else self.expected
        # a robot that was just switched on is in passive mode, since it was started, and counts from 0
        reset = gap and self.started and self.reading and (
            reading['mode'] == protocol.PASSIVE and self.counter.is_new(reading))
        if reset:
            self.counter.restart()
        try:
            travel = self.counter.update(reading, elapsed, read)
        except Implausible:
            self.implausible += 1
            if self.polled:
                self._lose(True)
            return
        if reset:   # it may have moved as commanded before it was switched off, or not at all: uniform in between
            left, right = self.expected
            travel = Travel(0.0, 0.0, ((left + right) / 2) ** 2 / 3,
                            ((right - left) / self.model.wheel_separation) ** 2 / 3)
        if gap:
            self._recover(elapsed, reset)
        self._count_from(time, read)
        self.reading, self.reading_time = reading, time
        self._move(time, travel)
        if self.gyro:
            turn = (travel.angle, travel.angle_variance + self.counter.rounding[1] ** 2)
            self.last_gyro = self.gyro.update(reading['analog_input'], elapsed, self.stands,
                                              turn if elapsed > SILENCE / SECOND else None)
        in_control = self.supervisor.in_control
        if self.supervisor.update(time, reading, self.gate.moving):
            self._write(time, sequences.take_control(self.model, self.settings.mode))
        if in_control and not self.supervisor.in_control:
            self.gate.halt()

    def _recover(self, elapsed, reset):
        self.answers = True
        if self.reading is None:
            self.info('The robot answers: %s' % self.model.name)
        else:
            self.warn('The robot answers again, after %.1f s%s'
                      % (elapsed, ': it was switched off or reset' if reset else ''))
        self.started = False

    def _move(self, time, travel):
        settings = self.settings
        corrected = Travel(travel.distance * settings.linear_correction, travel.angle * settings.angular_correction,
                           travel.distance_variance * settings.linear_correction ** 2,
                           travel.angle_variance * settings.angular_correction ** 2)
        self.odometry.move(corrected)
        difference = travel.angle * self.model.wheel_separation / 2
        self.left += travel.distance - difference
        self.right += travel.distance + difference
        if travel.distance or travel.angle or self.moved_time is None:
            self.moved_time = time
        self.since = Travel(*(one + other for one, other in zip(self.since, corrected)))

    @property
    def stands(self):
        """Whether the robot was not commanded to move, and has not moved, for a while."""
        return self.reading_time is not None and self.reading_time - self.moved_time >= STANDSTILL

    def state(self):
        """The State, if it is time for one and there is a new reading; else None."""
        if not (self.answers and self.state_due) or self.reading_time == self.reported:
            return None
        self.state_due = False
        elapsed = (self.reading_time - self.reported) / SECOND if self.reported is not None else 0.0
        distance, angle, *variances = self.since
        velocity, spread = (0.0, 0.0), (MEASURED, MEASURED)
        if elapsed > 0 and not (self.stands and not any(self.since)):
            velocity = distance / elapsed, angle / elapsed
            # the difference of two roundings
            spread = tuple((variance + 2 * rounding ** 2) / elapsed ** 2 + MEASURED
                           for variance, rounding in zip(variances, self.counter.rounding))
        self.reported, self.since = self.reading_time, NOWHERE
        gyro, self.last_gyro = self.last_gyro, None
        return State(self.reading_time, self.odometry.pose, self.odometry.covariance, velocity, spread,
                     (self.left, self.right), gyro)
