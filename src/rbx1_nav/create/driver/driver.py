"""Drives a Create: commands to bytes, bytes to odometry, on a clock in ns that the caller passes.

The clock must go on while the computer is suspended, and must never be set.
"""
from rbx1_nav.create import protocol
from rbx1_nav.create.driver import sequences
from rbx1_nav.create.driver.acceptance import OUTAGE, Acceptance
from rbx1_nav.create.driver.analog_gyro import AnalogGyro
from rbx1_nav.create.driver.contact import SILENCE, Contact
from rbx1_nav.create.driver.fractions import Fractions
from rbx1_nav.create.driver.gyro_check import Step
from rbx1_nav.create.driver.motion_report import MotionReport
from rbx1_nav.create.driver.sender import Sender
from rbx1_nav.create.driver.speeds import is_too_fast
from rbx1_nav.create.driver.stream import FrameReader, ReplyReader
from rbx1_nav.create.driver.supervisor import WHEEL_DROPS, Supervisor, causes
from rbx1_nav.create.driver.travel import Implausible, travel_of, unknown
from rbx1_nav.schedule import Schedule
from rbx1_nav.units import SECOND

REPLY_TIMEOUT = SECOND // 5     # ns from a query to the first byte of its reply
BYTE_TIMEOUT = SECOND // 20     # ns between two bytes of a reply
INSIST_WAIT = SECOND // 10      # ns without a confirmation of the last stop, after which it is repeated
STREAM_BAUD = 57600             # bits per second that a stream needs
GAP = 3                         # periods without a reading after which the gyro's rate does not stand for all of them


class Driver:
    """The state of one robot, whatever happens to its line."""

    def __init__(self, settings, gate, info, warn, error):
        """settings: Settings; gate: a CommandGate; info(text), warn(text), error(text): log a line."""
        self.settings = settings
        self.gate = gate
        self.info = info
        self.warn = warn
        self.error = error
        self.sender = Sender()
        self.commanded = self.sender.commanded
        self.contact = Contact(settings, self, warn)
        self.supervisor = Supervisor(settings.mode, settings.mode_plus_one, info, warn)
        self.acceptance = Acceptance(settings, gate, self.contact, self.supervisor)
        self.schedule = Schedule(settings.update_rate)
        self.due = None             # ns: a State of a reading that arrives after this is to be reported
        self.byte_time = 0          # ns, when the last bytes arrived
        # the robot
        self.reading = None         # the last one
        self.reading_time = None    # ns, when the robot made it
        self.received = None        # ns, when it arrived
        self.gyro_reading = None    # a Reading that was not reported yet
        self.leaving = None         # ns, since when the robot is to stop for good
        self.left = False           # whether it has confirmed that
        self.told = None            # ns, when it was told so last
        # what /diagnostics counts
        self.saturated = 0          # commands
        self.implausible = 0        # readings
        self.missed = 0             # replies
        self.use(settings.model)

    def use(self, model):
        """Drive a robot of this Model. It cannot change any more once there was a reading."""
        self.model = model
        baud = (self.contact.found or model).baud
        self.sender.byte = 10 * SECOND // baud
        # a Create has no stream, and that of a Create 2, a frame every 15 ms, needs a fast line
        self.polled = model is protocol.CREATE or baud < STREAM_BAUD
        self.reader = (ReplyReader(model, *sequences.queried(model)) if self.polled
                       else FrameReader(model, sequences.STREAMED))
        if self.reading is not None:
            return
        self.counter = travel_of(model, Fractions(self.settings.angle_fractions, self.warn))
        self.motion = MotionReport(self.settings, model, self.counter.rounding)
        self.gyro = (AnalogGyro(self.settings.gyro_range, self.settings.gyro_correction, self.error, self.info)
                     if model is protocol.CREATE and self.settings.has_gyro else None)

    # the line

    def attach(self, now, line):
        """A line was opened: see Contact. Raises OSError."""
        self.sender.open(line.write)
        self.reader.clear()
        self.contact.attach(now, line)

    def detach(self):
        """The line is lost, and with it the control of the robot, which keeps executing the last command."""
        self.contact.detach()
        self.lost_robot()
        self.sender.close()
        self._miss()

    def stop(self, now):
        """Stop the robot, until the next command."""
        self.gate.halt()
        if self.contact.found:
            self.sender.stop(now)

    def restore(self, now):
        """End whatever the robot may have begun when another process changed the settings of the port."""
        if self.leaving is None and self.contact.may_ask:
            self.sender.stop(now, after=sequences.STOP + (
                sequences.take_control(self.model, self.settings.mode) if self.supervisor.in_control else sequences.START))

    def leave(self, now):
        """Stop the robot, and leave it in passive mode. `left` shows whether it has confirmed that, if it can. Raises
        OSError."""
        self.gate.halt()
        if not self.contact.found:      # it was sent nothing that moves it
            self.left = True
            return
        self.leaving = self.told = now
        self.left = not self.contact.answers and self.motion.stands
        if self.contact.may_ask:
            self._leave(now)

    def _leave(self, now, before=b''):
        self.told = now + len(before) * self.sender.byte
        self.sender.stop(now, before, sequences.leave(self.model))
        self.ask(now)

    def _insist(self, now):
        """Say again that the robot is to stop, after what may have swallowed it before."""
        if not self.left and now - self.told > INSIST_WAIT:
            self._leave(now, sequences.FLUSH)

    # queries

    def ask(self, now, start=False):
        """Ask for a reading. start: of a robot that is started first."""
        self._miss()
        data = sequences.RESUME_STREAM
        if self.polled:
            self.commanded.ask(now)
            # the angle of a Create is not always asked for
            short = self.model is protocol.CREATE and not start and not self.counter.wants_angle(self.commanded.asked)
            numbers = sequences.queried(self.model)[short]
            self.reader.expect(numbers)
            data = sequences.query(numbers)
        if start:
            self.supervisor.restart()
            data = sequences.start(self.model, self.polled)
        self.sender.send(now, data)

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

    def command(self, now, linear, angular, others=(), sender=''):
        """Put a command in force, and send it at once; arguments, result and errors as of CommandGate.command().

        sender: the name of the node that it comes from. Raises RefusedCommand if the robot does not follow it now.
        """
        self.acceptance.check_sender(now, sender, bool(linear or angular))
        try:
            clamped = self.gate.command(now, linear, angular, others)
        finally:
            self.saturated += is_too_fast(self.gate.linear, self.gate.angular, self.model.wheel_separation)
            self._send_speeds(now)
        self.acceptance.check_obedience(now)
        return clamped

    def _must_stop(self):
        return self.commanded.moving and not any(self.acceptance.speeds(self.model))

    def _send_speeds(self, now):
        if self.contact.may_ask and (not self.sender.is_busy(now) or self._must_stop()):
            self.sender.drive(now, self.acceptance.speeds(self.model))
            if self.commanded.moving:
                self.motion.command(now)

    @property
    def is_ready(self):
        """Whether a robot has answered, and can be driven, or has a reason not to."""
        return self.reading is not None and bool(self.supervisor.in_control or self.supervisor.reason)

    # time

    def tick(self, now):
        """Do what is due: to be called after each receive(), and at least at the update rate. Returns whether the
        command in force has timed out. Raises OSError."""
        gate = self.gate
        timed_out = gate.moving and now >= gate.expiry
        if timed_out:
            gate.halt()
        if self.leaving is not None:
            if self.contact.searching:      # its starts end any motion
                self.contact.tick(now, self.reading_time)
            else:
                self._insist(now)
            return False
        self.contact.tick(now, self.reading_time)
        due = self.schedule.due(now)
        if due and self.due is None:
            self.due = now
        if due or self._must_stop():
            self._send_speeds(now)
        if due and self.polled and self.contact.may_ask and not self._awaits_reply(now):
            self.ask(now)
        return timed_out

    def until_tick(self, now):
        """How long it is until tick() has something to do, s."""
        times = [self.schedule.next] + [self.contact.search.next_time] * self.contact.searching
        return max(0, min(times) - now) / SECOND

    @property
    def awaited(self):
        """The reader of what is due now; None before the next tick."""
        if self.contact.searching:
            return self.contact.search
        return None if self.due is None and self.leaving is None else self.reader

    # readings

    def receive(self, now, data):
        """Process bytes of the robot."""
        if self.contact.searching:
            self.contact.receive(now, data)
            return
        if data:
            self.byte_time = now
        rejected = self.reader.rejected
        for reading in self.reader.feed(data):
            # the robot made a frame before it was on the line, and a reply when it received the query
            time = self.commanded.asked_time if self.polled else now - len(data) * self.sender.byte
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
        reset = self.contact.started and self.reading and (
            self.supervisor.is_passive(reading) and self.counter.is_reset(reading))
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

    def _step(self, elapsed, travel, expected, reading):
        """The Step of the gyro. expected: Expected travel by the commands."""
        bits = reading['bumps_and_wheel_drops']
        variance = travel.angle_variance + self.settings.errors.variances(travel)[1] + self.counter.rounding[1] ** 2
        return Step(elapsed, travel.angle, variance, (expected.right - expected.left) / self.model.wheel_separation,
                    self.motion.stands and not bits & WHEEL_DROPS,      # who lifts a robot may turn it
                    self.supervisor.in_control and self.settings.mode != protocol.PASSIVE, bool(bits),
                    elapsed * self.settings.update_rate > GAP)

    def _supervise(self, time, reading):
        before = self.supervisor.in_control
        if self.supervisor.update(time, reading, self.gate.moving):
            self.sender.send(time, sequences.take_control(self.model, self.settings.mode))
        if self.acceptance.feel(time, reading) or before and not self.supervisor.in_control:
            self.acceptance.lock(', '.join(causes(reading)) or 'the robot left the mode in which it is driven')

    def _recover(self, elapsed, reset):
        if self.reading is None:
            self.info('The robot answers: %s at %d baud' % (self.model.name, self.contact.found.baud))
            return
        what = 'the robot was switched off or reset' if reset else f'the robot did not answer for {elapsed:.1f} s'
        self.warn(f"The robot answers again, after {elapsed:.1f} s{': it was switched off or reset' if reset else ''}")
        if reset or elapsed > OUTAGE / SECOND:
            self.acceptance.lock(what)

    def lost_robot(self):
        """The robot no longer answers."""
        self.supervisor.forget()
        self.acceptance.lose_robot()

    def state(self):
        """The State, if one is due and there is a new reading for it; else None."""
        if not self.contact.answers or self.due is None or self.received <= self.due or not self.motion.is_new:
            return None
        self.due = None
        gyro, self.gyro_reading = self.gyro_reading, None
        return self.motion.state(gyro)
