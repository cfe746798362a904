"""Opcodes, modes, packets and dimensions in the documents of the Open Interface: see protocol.py."""
from math import pi

import pytest

from rbx1_nav.extras.create import protocol
from rbx1_nav.extras.create.protocol import CREATE, CREATE_2

LETTERS = dict(zip(range(4), 'opsf'))      # off, passive, safe, full
# modes that accept a command, and the mode after it, by opcode: Create p. 7 to 16, Create 2 p. 8 to 22
MODES = {
    'create': '7:psf>o 128:opsf>p 129:psf 130:psf>s 131:psf>s 132:psf>f 133:psf>o 134:psf>p 135:psf>p 136:psf>p '
              '137:sf 138:sf 139:sf 140:psf 141:sf 142:psf 143:psf>p 144:sf 145:sf 147:sf 148:psf 149:psf 150:psf '
              '151:sf 152:psf 153:psf 154:psf 155:psf 156:psf 157:psf 158:psf',
    'create2': '7:opsf>o 128:opsf>p 129:psf 130:psf>s 131:psf>s 132:psf>f 133:psf>o 134:psf>p 135:psf>p 136:psf>p '
               '137:sf 138:sf 139:sf 140:psf 141:sf 142:psf 143:psf>p 144:sf 145:sf 146:sf 148:psf 149:psf 150:psf '
               '162:sf 163:sf 164:sf 165:psf 167:psf 168:psf 173:psf>o'}
# ranges of the values, by packet number: Create p. 17 to 21, Create 2 p. 23 to 36
WORD, BYTE, SIGNED = (0, 65535), (0, 255), (-32768, 32767)
RANGES = {
    'create': {(0, 31): [7, 14, 32], (0, 1): [8, 9, 10, 11, 12, 13, 37], BYTE: [15, 16, 17], (0, 15): [18, 36],
               SIGNED: [19, 20, 23, 40], (0, 5): [21], WORD: [22, 25, 26], (-128, 127): [24],
               (0, 4095): [27, 28, 29, 30, 31], (0, 1023): [33], (0, 3): [34], (0, 4): [35], (0, 43): [38],
               (-500, 500): [39, 41, 42]},
    'create2': {(0, 15): [7, 36], (0, 31): [14], (0, 1): [8, 9, 10, 11, 12, 13, 37],
                BYTE: [15, 16, 17, 18, 32, 52, 53], SIGNED: [19, 20, 23, 40, 54, 55, 56, 57], (0, 5): [21],
                WORD: [22, 25, 26, 33, 43, 44], (-128, 127): [24], (0, 1023): [27],
                (0, 4095): [28, 29, 30, 31, 46, 47, 48, 49, 50, 51], (0, 3): [34, 58], (0, 4): [35], (0, 108): [38],
                (-500, 500): [39, 41, 42], (0, 127): [45]}}
both = pytest.mark.parametrize('model', [CREATE, CREATE_2], ids=['create', 'create2'])


@both
def test_the_modes_of_a_command(model):
    assert ' '.join(f"{opcode}:{''.join(LETTERS[mode] for mode in each.modes)}"
                    + ('' if each.mode is None else f'>{LETTERS[each.mode]}')
                    for opcode, each in sorted(model.commands.items())) == MODES[model.name]


@both
def test_the_ranges_of_the_packets(model):
    ranges = {}
    for number, packet in model.packets.items():
        assert packet.number == number
        ranges.setdefault((packet.low, packet.high), []).append(number)
    assert {key: sorted(numbers) for key, numbers in ranges.items()} == RANGES[model.name]


@both
def test_the_groups(model):
    groups = {0: (7, 26), 1: (7, 16), 2: (17, 20), 3: (21, 26), 4: (27, 34), 5: (35, 42), 6: (7, 42)}
    if model is CREATE_2:
        groups.update({100: (7, 58), 101: (43, 58), 106: (46, 51), 107: (54, 58)})
    assert {number: (each[0], each[-1]) for number, each in model.groups.items()} == groups
    assert all(list(each) == list(range(each[0], each[-1] + 1)) for each in model.groups.values())


def test_the_robots():
    """Create p. 4, 9, 11; Create 2 p. 4, 5, 13, 20, 31."""
    assert (CREATE.baud, CREATE.wheel_separation, CREATE.counts_per_metre) == (57600, 0.26, None)
    assert (CREATE_2.baud, CREATE_2.wheel_separation) == (115200, 0.235)
    assert CREATE_2.counts_per_metre == pytest.approx(508.8 / (pi * 0.072))


@pytest.mark.parametrize('data, checksum', [(b'', 0), (b'\0', 0), (b'\1', 255), (b'\xff', 1), (b'\x80\x80', 0)])
def test_a_checksum(data, checksum):
    assert protocol.checksum(data) == checksum
