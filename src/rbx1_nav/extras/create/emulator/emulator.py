"""An emulated Create: the robot's electronics, which execute the bytes on its serial line. All times are in ns."""
from __future__ import annotations

from math import inf
from struct import Struct
from typing import Callable, Sequence

from rbx1_nav.base.units import SECOND, clamp
from rbx1_nav.extras.create.emulator.body import Body
from rbx1_nav.extras.create.emulator.lights_and_songs import Panel
from rbx1_nav.extras.create.emulator.serial_line import SerialLine
from rbx1_nav.extras.create.protocol import (
    BAUD_RATES, COUNTED, IN_PLACE_LEFT, IN_PLACE_RIGHT, MAX_SPEED, OFF, PASSIVE, ROBOT_RADIUS, SAFE, STRAIGHT,
    UPDATE_PERIOD, Command, Model, encode_frame, packets_format, single_packets)

TICK = round(UPDATE_PERIOD * SECOND)
BOOT_TIME = SECOND      # time after power-on during which the robot receives nothing
MAX_FRAME = 255         # data bytes in a frame of the stream
MAX_PWM = 255
# cleaning, docking and the demos of the Create. A driver can only see that the robot drives although it was not asked
# to, so each of these programs drives the same circle: mm/s, mm
PROGRAMS, CIRCLE = {'spot', 'cover', 'max', 'dock', 'demo'}, (200, 300)
DEMOS, ABORT = 10, 255      # number of demos (Create p. 8); -1, the number that stops the running demo
PAIR = Struct('>hh')
REQUESTED = range(39, 43)       # packets of the requested motion


def command_size(model: Model, data: bytes | bytearray) -> int | None:
    """Return the size in bytes of the command at the start of `data`; None if there are too few bytes to determine it.
    """
    size = model.commands[data[0]].size
    if isinstance(size, int):
        return 1 + size
    if size == COUNTED:
        return 2 + data[1] if len(data) > 1 else None
    return 3 + 2 * data[2] if len(data) > 2 else None


class EmulatedCreate:
    """The robot on a SerialLine."""

    def __init__(self, body: Body, line: SerialLine, now: int,
                 on_command: Callable[[int, bytes], None] | None = None) -> None:
        """line: at the robot's initial baud rate.

        on_command(time, data): called with the bytes of each command that arrives, even if the robot ignores it.
        """
        self.model = body.model
        self.body = body
        self.line = line
        self.on_command = on_command or (lambda time, data: None)
        self.programs_started = 0
        self.program_runs = False
        self._baud = line.baud
        self._deaf_until: float = now
        self._start(now)

    def switch_on(self, now: int) -> None:
        """Restart, as after inserting the battery."""
        self._start(now)
        self._deaf_until = now + BOOT_TIME
        self.line.from_robot(self.model.boot_text, now)

    def _start(self, now: int) -> None:
        self.mode = OFF
        self.now = now
        self.line.baud = self._baud
        self.body.drive(0, 0)
        self.body.reset_counters()
        self._stop_program()
        self._input = bytearray()
        self._next_update = now + TICK
        self._stream: list[int] = []
        self._streaming = False
        self.panel = Panel(now)

    # time

    def receive(self, data: bytes, now: int) -> None:
        self._run(now)
        self.line.from_host(data, now)

    def advance(self, now: int) -> bytes:
        """Advance to `now`. Returns the bytes that have arrived at the host."""
        self._run(now)
        return self.line.received(now)

    @property
    def next_time(self) -> int:
        """The time at which advance() next has something to do."""
        times = (self._next_update, self.line.next_to_robot, self.line.next_to_host)
        return min(time for time in times if time is not None)

    def _run(self, now: int) -> None:
        while True:
            arrival = self.line.next_to_robot
            if arrival is not None and arrival <= min(now, self._next_update):
                self._go_to(arrival)
                self._on_byte(self.line.receive_byte())
            elif self._next_update <= now:
                self._go_to(self._next_update)
                self._next_update += TICK
                self._update()
            else:
                break
        self._go_to(now)

    def _go_to(self, time: int) -> None:
        self.body.advance(max(0, time - self.now))
        self.now = self.panel.now = max(time, self.now)

    # the update every 15 ms

    def _update(self) -> None:
        # the robot charges only in these modes (Create 2 p. 7)
        self.body.sample(UPDATE_PERIOD, self.mode in (OFF, PASSIVE))
        if not self.body.charge:
            self._start(self.now)
            return
        if self.mode == SAFE and self._unsafe():
            self._enter(PASSIVE)
        if self.body.dropped or self.body.cliffs or self.body.docked:
            self._stop_program()
        if self.program_runs:
            self._drive_curve(*CIRCLE)
        if self._streaming:
            self.line.from_robot(encode_frame(self.model, self._stream, self._values(self._stream)), self.now)

    def _unsafe(self) -> bool:
        """Return whether something has happened that stops safe mode (Create p. 6, Create 2 p. 7)."""
        body = self.body
        linear, angular = body.velocity
        small_radius = abs(linear) < abs(angular) * ROBOT_RADIUS
        return body.dropped or body.docked or body.charger or bool(body.cliffs and (linear > 0 or small_radius))

    def _enter(self, mode: int) -> None:
        if mode in (OFF, PASSIVE):
            self._drive(0, 0)
            self.body.values.update((packet.name, 0) for packet in single_packets(self.model, REQUESTED))
        self.mode = mode

    # bytes and commands

    def _on_byte(self, byte: int) -> None:
        if self.now < self._deaf_until or not self.body.charge:
            return
        self._input.append(byte)
        self._execute()

    def _execute(self) -> None:
        while self._input:
            command = self.model.commands.get(self._input[0])
            if command is None or (self.mode == OFF and OFF not in command.modes):
                del self._input[0]      # while the interface is off, data bytes are not skipped
                continue
            size = command_size(self.model, self._input)
            if size is None or size > len(self._input):
                break
            data = bytes(self._input[:size])
            del self._input[:size]
            self.on_command(self.now, data)
            if self.mode in command.modes:
                self._do(command, data[1:])

    def _do(self, command: Command, data: bytes) -> None:
        handler = getattr(self, f'_do_{command.name}', None) or getattr(self.panel, command.name, None)
        if handler:     # the other commands have no visible effect
            handler(data)
        if command.mode is not None:
            self._enter(command.mode)
            if command.name not in PROGRAMS:
                self._stop_program()

    def _do_reset(self, _: bytes) -> None:
        self.switch_on(self.now)
        self._deaf_until = self.now + round(self.model.reset_time * SECOND)

    def _do_power(self, _: bytes) -> None:
        self._start(self.now)
        self._deaf_until = inf      # until power-on

    def _do_stop(self, _: bytes) -> None:
        self._streaming = False

    def _do_baud(self, data: bytes) -> None:
        if data[0] < len(BAUD_RATES):
            self.line.baud = BAUD_RATES[data[0]]

    # programs

    def _start_program(self) -> None:
        self.programs_started += 1
        self.program_runs = True

    def _stop_program(self) -> None:
        if self.program_runs:
            self.program_runs = False
            self.body.drive(0, 0)

    def _do_spot(self, _: bytes) -> None:
        if self.program_runs:       # like each of the robot's buttons, this pauses it (Create 2 p. 11-12)
            self._stop_program()
        else:
            self._start_program()

    _do_cover = _do_max = _do_dock = _do_spot

    def _do_demo(self, data: bytes) -> None:
        if data[0] == ABORT:
            self._stop_program()
        elif data[0] < DEMOS:
            self._start_program()

    # wheels

    def _drive(self, left: float, right: float) -> None:
        self.body.drive(clamp(left, MAX_SPEED), clamp(right, MAX_SPEED))

    def _do_drive(self, data: bytes) -> None:
        velocity, radius = PAIR.unpack(data)
        velocity = int(clamp(velocity, MAX_SPEED))
        self.body.values.update(requested_velocity=velocity, requested_radius=radius)
        self._drive_curve(velocity, radius)

    def _drive_curve(self, velocity: float, radius: float) -> None:
        """Drive in a curve. velocity: mm/s; radius: mm, or a special value of the Drive command."""
        if radius in STRAIGHT:
            self._drive(velocity, velocity)
        elif radius in (IN_PLACE_LEFT, IN_PLACE_RIGHT):
            self._drive(-velocity * radius, velocity * radius)
        else:
            # the documents do not define a radius of 0
            half = 500 * self.model.wheel_separation / radius if radius else 0
            self._drive(velocity * (1 - half), velocity * (1 + half))

    def _do_drive_direct(self, data: bytes) -> None:
        right, left = (int(clamp(speed, MAX_SPEED)) for speed in PAIR.unpack(data))
        self.body.values.update(requested_right_velocity=right, requested_left_velocity=left)
        self._drive(left, right)

    def _do_drive_pwm(self, data: bytes) -> None:
        right, left = (clamp(pwm, MAX_PWM) * MAX_SPEED / MAX_PWM for pwm in PAIR.unpack(data))
        self._drive(left, right)

    # sensors

    def _values(self, numbers: Sequence[int]) -> dict[str, int]:
        """Return the values of all packets, by name. Reading a requested distance or angle restarts its count.

        numbers: requested packets and groups.
        """
        body = self.body
        names = {packet.name for packet in single_packets(self.model, numbers)}
        return dict(
            body.values, mode=self.mode + int(self.model.mode_plus_one),
            stream_packets=len(self._stream), song_number=self.panel.number, song_playing=int(self.panel.is_playing),
            distance=body.distance.take() if 'distance' in names else 0,
            angle=body.angle.take() if 'angle' in names else 0)

    def _known(self, numbers: Sequence[int]) -> bool:
        return all(number in self.model.packets or number in self.model.groups for number in numbers)

    def _do_sensors(self, data: bytes) -> None:
        self._do_query_list(bytes((1,)) + data)

    def _do_query_list(self, data: bytes) -> None:
        numbers = data[1:]
        if self._known(numbers):
            packets, values = single_packets(self.model, numbers), self._values(numbers)
            self.line.from_robot(packets_format(packets).pack(*(values[packet.name] for packet in packets)), self.now)

    def _do_stream(self, data: bytes) -> None:
        numbers = list(data[1:])
        if self._known(numbers) and (
                len(numbers) + packets_format(single_packets(self.model, numbers)).size <= MAX_FRAME):
            self._stream, self._streaming = numbers, bool(numbers)

    def _do_pause_resume_stream(self, data: bytes) -> None:
        self._streaming = bool(data[0] and self._stream)
