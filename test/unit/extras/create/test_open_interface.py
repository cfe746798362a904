"""The tables of the Open Interface match the documents (see protocol.py), and encode and decode values."""
from math import pi

import pytest
from hypothesis import given
from hypothesis import strategies as st

from rbx1_nav.extras.create.protocol import (
    COUNTED, CREATE, CREATE_2, FRAME_HEADER, MODELS, NOTES, command, encode_frame, packets_format, single_packets)

from robots import both

# opcode, data bytes (n: the first one is a count; p: the second one counts pairs), modes that accept the command, and
# the mode after it (off, passive, safe, full): Create p. 7 to 16, Create 2 p. 8 to 22
BOTH = ('128:0 opsf>p, 129:1 psf, 130:0 psf>s, 131:0 psf>s, 132:0 psf>f, 133:0 psf>o, 134:0 psf>p, 135:0 psf>p, '
        '137:4 sf, 138:1 sf, 139:3 sf, 140:p psf, 141:1 sf, 142:1 psf, 143:0 psf>p, 144:3 sf, 145:4 sf, 148:n psf, '
        '149:n psf, 150:1 psf, ')
COMMANDS = {
    'create': BOTH + '7:0 psf>o, 136:1 psf>p, 147:1 sf, 151:1 sf, 152:n psf, 153:0 psf, 154:0 psf, 155:1 psf, '
                     '156:2 psf, 157:2 psf, 158:1 psf',
    'create2': BOTH + '7:0 opsf>o, 136:0 psf>p, 146:4 sf, 162:2 sf, 163:4 sf, 164:4 sf, 165:1 psf, 167:15 psf, '
                      '168:3 psf, 173:0 psf>o'}
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
# first and last packet, and size in bytes, by group: Create p. 17, Create 2 p. 23
GROUPS = {0: (7, 26, 26), 1: (7, 16, 10), 2: (17, 20, 6), 3: (21, 26, 10), 4: (27, 34, 14), 5: (35, 42, 12),
          6: (7, 42, 52)}
GROUPS_2 = {**GROUPS, 100: (7, 58, 80), 101: (43, 58, 28), 106: (46, 51, 12), 107: (54, 58, 9)}


@both
def test_the_commands(model):
    letters, modes = {COUNTED: 'n', NOTES: 'p'}, 'opsf'
    assert {f'{opcode}:{letters.get(each.size, each.size)} {"".join(modes[mode] for mode in each.modes)}'
            + ('' if each.mode is None else f'>{modes[each.mode]}')
            for opcode, each in model.commands.items()} == set(COMMANDS[model.name].split(', '))


@both
def test_the_packets_and_groups(model):
    ranges = {}
    for number, packet in model.packets.items():
        form = packets_format([packet])
        assert packet.number == number
        for value in packet.low, packet.high:
            assert form.unpack(form.pack(value)) == (value,)
        ranges.setdefault((packet.low, packet.high), []).append(number)
    assert {key: sorted(numbers) for key, numbers in ranges.items()} == RANGES[model.name]
    assert {number: (each[0], each[-1], packets_format(single_packets(model, [number])).size)
            for number, each in model.groups.items()} == (GROUPS if model is CREATE else GROUPS_2)
    assert all(list(each) == list(range(each[0], each[-1] + 1)) for each in model.groups.values())


def test_the_robots():
    """Create p. 4, 9, 11; Create 2 p. 4, 5, 13, 20, 31."""
    assert (CREATE.baud, CREATE.wheel_separation, CREATE.counts_per_metre) == (57600, 0.26, None)
    assert (CREATE_2.baud, CREATE_2.wheel_separation) == (115200, 0.235)
    assert CREATE_2.counts_per_metre == pytest.approx(508.8 / (pi * 0.072))


@st.composite
def frames(draw):
    """Draw (model, numbers of packets and groups, values by packet name)."""
    model = draw(st.sampled_from(list(MODELS.values())))
    numbers = draw(st.lists(st.sampled_from(list(model.packets) + list(model.groups)), min_size=1, max_size=5))
    values = {packet.name: draw(st.integers(packet.low, packet.high)) for packet in single_packets(model, numbers)}
    return model, numbers, values


@given(frames())
def test_a_frame_encodes_and_decodes_back(frame):
    model, numbers, values = frame
    if len(numbers) + packets_format(single_packets(model, numbers)).size > 255:
        return      # too long for its length byte
    data = encode_frame(model, numbers, values)
    assert data[:2] == bytes((FRAME_HEADER, len(data) - 3)) and sum(data) % 256 == 0
    data = data[2:-1]
    for number in numbers:
        packets = single_packets(model, [number])
        form = packets_format(packets)
        assert data[0] == number
        assert list(form.unpack(data[1:1 + form.size])) == [values[packet.name] for packet in packets]
        data = data[1 + form.size:]
    assert not data


def test_the_bytes_of_the_document():
    values = {'cliff_front_left_signal': 549, 'virtual_wall': 0}
    assert encode_frame(CREATE, [29, 13], values) == bytes((19, 5, 29, 2, 37, 13, 0, 151))
    assert command('leds', 8, 0, 128) == bytes((139, 8, 0, 128))
