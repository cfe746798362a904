"""The tables of the Open Interface match the documents, and encode and decode values."""
from struct import Struct

import pytest
from hypothesis import given
from hypothesis import strategies as st

from rbx1_nav.extras.create.protocol import (
    COUNTED, CREATE, CREATE_2, FRAME_HEADER, MODELS, NOTES, command, drive_direct, encode_frame,
    packets_format, single_packets)

models = st.sampled_from(list(MODELS.values()))
PACKETS = [pytest.param(packet, id='%s-%d' % (model.name, packet.number))
           for model in MODELS.values() for packet in model.packets.values()]


@st.composite
def frames(draw):
    """Draw (model, numbers of packets and groups, values by packet name)."""
    model = draw(models)
    numbers = draw(st.lists(st.sampled_from(list(model.packets) + list(model.groups)), min_size=1, max_size=5))
    values = {packet.name: draw(st.integers(packet.low, packet.high)) for packet in single_packets(model, numbers)}
    return model, numbers, values


@pytest.mark.parametrize('packet', PACKETS)
def test_every_value_of_a_packet_encodes_and_decodes_back(packet):
    form = packets_format([packet])
    for value in range(packet.low, packet.high + 1):
        assert form.unpack(form.pack(value)) == (value,)


def test_values_are_big_endian():
    assert packets_format([CREATE.packets[19]]).pack(-2) == b'\xff\xfe'
    assert packets_format([CREATE.packets[25]]).pack(0x0102) == b'\x01\x02'


# sizes in bytes: Create p. 17, Create 2 p. 23
@pytest.mark.parametrize('model, group, size', [
    (CREATE, 0, 26), (CREATE, 1, 10), (CREATE, 2, 6), (CREATE, 3, 10), (CREATE, 4, 14), (CREATE, 5, 12),
    (CREATE, 6, 52),
    (CREATE_2, 0, 26), (CREATE_2, 1, 10), (CREATE_2, 2, 6), (CREATE_2, 3, 10), (CREATE_2, 4, 14), (CREATE_2, 5, 12),
    (CREATE_2, 6, 52), (CREATE_2, 100, 80), (CREATE_2, 101, 28), (CREATE_2, 106, 12), (CREATE_2, 107, 9)])
def test_the_size_of_a_group(model, group, size):
    assert packets_format(single_packets(model, [group])).size == size


# data bytes by opcode: Create p. 7 to 16, Create 2 p. 8 to 22; n: the first byte is a count; p: the second counts pairs
@pytest.mark.parametrize('model, sizes', [
    (CREATE, '7:0 128:0 129:1 130:0 131:0 132:0 133:0 134:0 135:0 136:1 137:4 138:1 139:3 140:p 141:1 142:1 143:0 '
             '144:3 145:4 147:1 148:n 149:n 150:1 151:1 152:n 153:0 154:0 155:1 156:2 157:2 158:1'),
    (CREATE_2, '7:0 128:0 129:1 130:0 131:0 132:0 133:0 134:0 135:0 136:0 137:4 138:1 139:3 140:p 141:1 142:1 143:0 '
               '144:3 145:4 146:4 148:n 149:n 150:1 162:2 163:4 164:4 165:1 167:15 168:3 173:0')])
def test_the_size_of_a_command(model, sizes):
    letters = {COUNTED: 'n', NOTES: 'p'}
    assert ' '.join(f'{opcode}:{letters.get(each.size, each.size)}'
                    for opcode, each in sorted(model.commands.items())) == sizes


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


def test_the_frame_of_the_document():
    values = {'cliff_front_left_signal': 549, 'virtual_wall': 0}
    assert encode_frame(CREATE, [29, 13], values) == bytes((19, 5, 29, 2, 37, 13, 0, 151))


@given(st.integers(-500, 500), st.integers(-500, 500))
def test_drive_direct(right, left):
    assert Struct('>Bhh').unpack(drive_direct(right, left)) == (145, right, left)


def test_a_command():
    assert command('start') == bytes((128,)) and command('leds', 8, 0, 128) == bytes((139, 8, 0, 128))
