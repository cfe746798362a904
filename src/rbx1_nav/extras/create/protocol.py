"""The Open Interface of the iRobot Create and Create 2: commands, sensor packets, and the frames of the stream.

Both the driver and the emulated robot use these tables. The source documents, with the pages of each part:

iRobot Create Open Interface (OI) Specification, 2006:
    serial port 5, modes 6, start and modes 7, demos 8, actuators 9-12, input 13-14, scripts 15, waiting 15-16,
    sensor packets 17-21, quick reference 22-25
iRobot Create 2 Open Interface (OI) Specification based on the iRobot Roomba 600, August 10, 2016:
    serial port 4, dimensions 5, modes 7, start 8-9, modes 10, cleaning 11-12, actuators 13-20, input 21-22,
    sensor packets 23-36, quick reference 37-39
"""
from __future__ import annotations

from math import pi
from struct import Struct
from typing import Iterable, Mapping, NamedTuple, Optional, Tuple

MAX_SPEED = 500         # mm/s, wheel speed limit in either direction (Create p. 9, Create 2 p. 13)
UPDATE_PERIOD = 0.015   # s, between two frames of the stream (Create p. 13, Create 2 p. 21)
ROBOT_RADIUS = 0.165    # m
MIN_VOLTAGE, MAX_VOLTAGE = 5000, 25000      # mV, battery voltage of a running robot
FRAME_HEADER = 19       # the first byte of a frame (Create p. 13, Create 2 p. 22)
NOTHING_RECEIVED = 255  # infrared character of a Create; 0 on a Create 2 and in create_robot

OFF, PASSIVE, SAFE, FULL = range(4)     # values of packet 35
MODE_NAMES = ('off', 'passive', 'safe', 'full')

# bits of packet 7; the caster bit exists only on the Create (Create p. 17, Create 2 p. 24)
BUMP_RIGHT, BUMP_LEFT, WHEEL_DROP_RIGHT, WHEEL_DROP_LEFT, WHEEL_DROP_CASTOR = 1, 2, 4, 8, 16
BUMPS, WHEEL_DROPS = BUMP_LEFT | BUMP_RIGHT, WHEEL_DROP_LEFT | WHEEL_DROP_RIGHT | WHEEL_DROP_CASTOR
CLIFFS = ('cliff_left', 'cliff_front_left', 'cliff_front_right', 'cliff_right')     # packets 9 to 12
CHARGER, DOCK = 1, 2        # bits of packet 34

# special values of a radius in mm (Create p. 9, Create 2 p. 13)
STRAIGHT = (32767, -32768)
IN_PLACE_LEFT, IN_PLACE_RIGHT = 1, -1

# bits per second, indexed by the code in the Baud command (Create p. 7, Create 2 p. 9)
BAUD_RATES = (300, 600, 1200, 2400, 4800, 9600, 14400, 19200, 28800, 38400, 57600, 115200)
BAUD_RANGE = f'{BAUD_RATES[0]} to {BAUD_RATES[-1]}'     # as shown in a usage text


class Packet(NamedTuple):
    """A sensor packet with one value."""

    number: int
    name: str
    format: str     # struct format character, big-endian
    low: int        # smallest value
    high: int       # largest value


_Range = Tuple[int, int]

# number, name, format, range on the Create (None: no such packet), range on the Create 2; as comments, units
_PACKETS: Tuple[Tuple[int, str, str, Optional[_Range], _Range], ...] = (
    (7, 'bumps_and_wheel_drops', 'B', (0, 31), (0, 15)),
    (8, 'wall', 'B', (0, 1), (0, 1)),
    (9, 'cliff_left', 'B', (0, 1), (0, 1)),
    (10, 'cliff_front_left', 'B', (0, 1), (0, 1)),
    (11, 'cliff_front_right', 'B', (0, 1), (0, 1)),
    (12, 'cliff_right', 'B', (0, 1), (0, 1)),
    (13, 'virtual_wall', 'B', (0, 1), (0, 1)),
    (14, 'overcurrents', 'B', (0, 31), (0, 31)),
    (15, 'dirt_detect', 'B', (0, 255), (0, 255)),       # unused on the Create
    (16, 'unused_16', 'B', (0, 255), (0, 255)),
    (17, 'infrared', 'B', (0, 255), (0, 255)),
    (18, 'buttons', 'B', (0, 15), (0, 255)),
    (19, 'distance', 'h', (-32768, 32767), (-32768, 32767)),  # mm
    (20, 'angle', 'h', (-32768, 32767), (-32768, 32767)),  # degrees
    (21, 'charging_state', 'B', (0, 5), (0, 5)),
    (22, 'voltage', 'H', (0, 65535), (0, 65535)),  # mV
    (23, 'current', 'h', (-32768, 32767), (-32768, 32767)),  # mA
    (24, 'temperature', 'b', (-128, 127), (-128, 127)),  # degrees C
    (25, 'charge', 'H', (0, 65535), (0, 65535)),  # mAh
    (26, 'capacity', 'H', (0, 65535), (0, 65535)),  # mAh
    (27, 'wall_signal', 'H', (0, 4095), (0, 1023)),
    (28, 'cliff_left_signal', 'H', (0, 4095), (0, 4095)),
    (29, 'cliff_front_left_signal', 'H', (0, 4095), (0, 4095)),
    (30, 'cliff_front_right_signal', 'H', (0, 4095), (0, 4095)),
    (31, 'cliff_right_signal', 'H', (0, 4095), (0, 4095)),
    (32, 'digital_inputs', 'B', (0, 31), (0, 255)),     # unused on the Create 2
    (33, 'analog_input', 'H', (0, 1023), (0, 65535)),   # 0 to 5 V; unused on the Create 2
    (34, 'charging_sources', 'B', (0, 3), (0, 3)),
    (35, 'mode', 'B', (0, 4), (0, 4)),      # full mode is 3, but some robots report it as 4
    (36, 'song_number', 'B', (0, 15), (0, 15)),
    (37, 'song_playing', 'B', (0, 1), (0, 1)),
    (38, 'stream_packets', 'B', (0, 43), (0, 108)),
    (39, 'requested_velocity', 'h', (-500, 500), (-500, 500)),  # mm/s
    (40, 'requested_radius', 'h', (-32768, 32767), (-32768, 32767)),  # mm
    (41, 'requested_right_velocity', 'h', (-500, 500), (-500, 500)),  # mm/s
    (42, 'requested_left_velocity', 'h', (-500, 500), (-500, 500)),  # mm/s
    (43, 'left_encoder', 'H', None, (0, 65535)),  # counts
    (44, 'right_encoder', 'H', None, (0, 65535)),  # counts
    (45, 'light_bumper', 'B', None, (0, 127)),
    (46, 'light_bump_left_signal', 'H', None, (0, 4095)),
    (47, 'light_bump_front_left_signal', 'H', None, (0, 4095)),
    (48, 'light_bump_center_left_signal', 'H', None, (0, 4095)),
    (49, 'light_bump_center_right_signal', 'H', None, (0, 4095)),
    (50, 'light_bump_front_right_signal', 'H', None, (0, 4095)),
    (51, 'light_bump_right_signal', 'H', None, (0, 4095)),
    (52, 'infrared_left', 'B', None, (0, 255)),
    (53, 'infrared_right', 'B', None, (0, 255)),
    (54, 'left_motor_current', 'h', None, (-32768, 32767)),  # mA
    (55, 'right_motor_current', 'h', None, (-32768, 32767)),  # mA
    (56, 'main_brush_current', 'h', None, (-32768, 32767)),  # mA
    (57, 'side_brush_current', 'h', None, (-32768, 32767)),  # mA
    (58, 'stasis', 'B', None, (0, 3)))

# group number: its first and last packet (Create p. 17, Create 2 p. 23)
_GROUPS = {0: (7, 26), 1: (7, 16), 2: (17, 20), 3: (21, 26), 4: (27, 34), 5: (35, 42), 6: (7, 42)}
_GROUPS_2 = {100: (7, 58), 101: (43, 58), 106: (46, 51), 107: (54, 58)}

COUNTED = 'counted'     # the first data byte is the number of data bytes that follow
NOTES = 'notes'         # the second data byte is the number of pairs that follow

STARTED, DRIVING = (PASSIVE, SAFE, FULL), (SAFE, FULL)
ALWAYS = (OFF,) + STARTED


class Command(NamedTuple):
    opcode: int
    name: str
    size: int | str         # number of data bytes, COUNTED or NOTES
    modes: tuple[int, ...]  # modes that accept the command
    mode: int | None        # mode after the command; None: unchanged


_BOTH = (
    Command(128, 'start', 0, ALWAYS, PASSIVE),
    Command(129, 'baud', 1, STARTED, None),
    Command(130, 'control', 0, STARTED, SAFE),      # from the Roomba's interface; both robots still accept it
    Command(131, 'safe', 0, STARTED, SAFE),
    Command(132, 'full', 0, STARTED, FULL),
    Command(133, 'power', 0, STARTED, OFF),         # not in the Create document; passive mode in the Create 2 document
    Command(134, 'spot', 0, STARTED, PASSIVE),
    Command(135, 'cover', 0, STARTED, PASSIVE),     # Create 2: clean
    Command(137, 'drive', 4, DRIVING, None),
    Command(139, 'leds', 3, DRIVING, None),
    Command(140, 'song', NOTES, STARTED, None),
    Command(141, 'play_song', 1, DRIVING, None),
    Command(142, 'sensors', 1, STARTED, None),
    Command(143, 'dock', 0, STARTED, PASSIVE),      # Create: cover and dock
    Command(145, 'drive_direct', 4, DRIVING, None),
    Command(148, 'stream', COUNTED, STARTED, None),
    Command(149, 'query_list', COUNTED, STARTED, None),
    Command(150, 'pause_resume_stream', 1, STARTED, None))
_CREATE = (
    Command(7, 'reset', 0, STARTED, OFF),           # not in the document; create_node sends it
    Command(136, 'demo', 1, STARTED, PASSIVE),
    Command(138, 'low_side_drivers', 1, DRIVING, None),
    Command(144, 'pwm_low_side_drivers', 3, DRIVING, None),
    Command(147, 'digital_outputs', 1, DRIVING, None),
    Command(151, 'send_ir', 1, DRIVING, None),
    Command(152, 'script', COUNTED, STARTED, None),
    Command(153, 'play_script', 0, STARTED, None),
    Command(154, 'show_script', 0, STARTED, None),
    Command(155, 'wait_time', 1, STARTED, None),
    Command(156, 'wait_distance', 2, STARTED, None),
    Command(157, 'wait_angle', 2, STARTED, None),
    Command(158, 'wait_event', 1, STARTED, None))
_CREATE_2 = (
    Command(7, 'reset', 0, ALWAYS, OFF),
    Command(136, 'max', 0, STARTED, PASSIVE),
    Command(138, 'motors', 1, DRIVING, None),
    Command(144, 'pwm_motors', 3, DRIVING, None),
    Command(146, 'drive_pwm', 4, DRIVING, None),
    Command(162, 'scheduling_leds', 2, DRIVING, None),
    Command(163, 'digit_leds_raw', 4, DRIVING, None),
    Command(164, 'digit_leds_ascii', 4, DRIVING, None),
    Command(165, 'push_buttons', 1, STARTED, None),
    Command(167, 'schedule', 15, STARTED, None),
    Command(168, 'set_day_time', 3, STARTED, None),
    Command(173, 'stop', 0, STARTED, OFF))


class Model(NamedTuple):
    """What a robot has and does. A new one is an entry in MODELS."""

    name: str
    baud: int                           # bits per second, after power-on
    wheel_separation: float             # m
    counts_per_metre: float | None      # encoder counts; None without encoders
    packets: dict[int, Packet]          # by number
    groups: dict[int, tuple[int, ...]]  # packet numbers by group number
    commands: dict[int, Command]        # by opcode
    has_gyro_board: bool = False        # whether a TurtleBot's gyro fits: analog input, and its power at an output
    mode_plus_one: bool = False         # whether packet 35 is the mode plus one
    reset_time: float = 1.0             # s after a reset in which it receives nothing
    boot_text: bytes = b''              # what it sends when it is switched on

    def has(self, name: str) -> bool:
        """Return whether there is a command with this name."""
        return any(each.name == name for each in self.commands.values())


def _packets_of(groups: Mapping[int, tuple[int, int]]) -> dict[int, tuple[int, ...]]:
    return {number: tuple(range(first, last + 1)) for number, (first, last) in groups.items()}


CREATE = Model(
    name='create', baud=57600, wheel_separation=0.26, counts_per_metre=None,
    packets={number: Packet(number, name, form, *values) for number, name, form, values, _ in _PACKETS if values},
    groups=_packets_of(_GROUPS), commands={each.opcode: each for each in _BOTH + _CREATE},
    has_gyro_board=True, reset_time=3.0)    # its boot loader takes 3 s (Create p. 10)
# 72 mm wheels, 508.8 counts per revolution (Create 2, packet 43)
CREATE_2 = Model(
    name='create2', baud=115200, wheel_separation=0.235, counts_per_metre=508.8 / (pi * 0.072),
    packets={number: Packet(number, name, form, *values) for number, name, form, _, values in _PACKETS},
    groups=_packets_of({**_GROUPS, **_GROUPS_2}), commands={each.opcode: each for each in _BOTH + _CREATE_2},
    boot_text=b'bl-start\r\nSTR730\r\nRoomba by iRobot!\r\nr3_robot/tags/release-3.5.4\r\n')
# a 600 with Wi-Fi (create_robot, issue 64)
ROOMBA_600_WIFI = CREATE_2._replace(name='roomba600_wifi', mode_plus_one=True)
MODELS = {model.name: model for model in (CREATE, CREATE_2, ROOMBA_600_WIFI)}
OPCODES = {command.name: command.opcode for command in _BOTH + _CREATE + _CREATE_2}


def command(name: str, *data: int) -> bytes:
    """Return the bytes of a command. data: its data bytes, from 0 to 255."""
    return bytes((OPCODES[name], *data))


def drive_direct(right: int, left: int) -> bytes:
    """Return the bytes of a Drive Direct command. right, left: wheel speeds, mm/s. Raises struct.error."""
    return command('drive_direct', *Struct('>hh').pack(right, left))


def single_packets(model: Model, numbers: Iterable[int]) -> list[Packet]:
    """Expand packet and group numbers to Packets, in the order in which they are sent. Raises KeyError."""
    return [model.packets[each] for number in numbers for each in model.groups.get(number, (number,))]


def packets_format(packets: Iterable[Packet]) -> Struct:
    """Return the Struct of the concatenated values of Packets."""
    return Struct('>' + ''.join(packet.format for packet in packets))


def encode_frame(model: Model, numbers: Iterable[int], values: Mapping[str, int]) -> bytes:
    """Return a frame of the stream. numbers: packets and groups; values: by packet name."""
    data = bytearray()
    for number in numbers:
        packets = single_packets(model, [number])
        data.append(number)
        data += packets_format(packets).pack(*(values[packet.name] for packet in packets))
    frame = bytes((FRAME_HEADER, len(data))) + data
    return frame + bytes((-sum(frame) & 0xff,))     # the sum of a frame is a multiple of 256
