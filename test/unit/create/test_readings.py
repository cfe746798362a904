"""Readings are found in bytes that arrive in arbitrary pieces, and corrupted readings are counted and dropped."""
import random

from hypothesis import given, strategies
import pytest

from rbx1_nav.create import protocol
from rbx1_nav.create.driver import sequences
from rbx1_nav.create.driver.stream import FrameReader, ReplyReader

MODEL, NUMBERS = protocol.CREATE_2, sequences.STREAMED
PACKETS = protocol.single_packets(MODEL, NUMBERS)


def values(seed):
    """Return random valid values of the packets, by name."""
    choose = random.Random(seed)
    return {packet.name: choose.randint(packet.low, packet.high) for packet in PACKETS}


def frame(seed):
    return protocol.encode_frame(MODEL, NUMBERS, values(seed))


def feed(reader, data, size):
    """Return all readings in data that arrives in pieces."""
    return [reading for start in range(0, len(data), size) for reading in reader.feed(data[start:start + size])]


@given(strategies.lists(strategies.integers(0, 10 ** 6), max_size=5), strategies.integers(1, 100))
def test_frames_in_pieces(seeds, size):
    reader = FrameReader(MODEL, NUMBERS)
    assert feed(reader, b''.join(map(frame, seeds)), size) == list(map(values, seeds))
    assert reader.rejected == reader.skipped == 0


@given(strategies.binary(max_size=60), strategies.integers(1, 100))
def test_garbage_before_a_frame(garbage, size):
    reader = FrameReader(MODEL, NUMBERS)
    # the garbage may look like the beginning of a frame, which then includes the first frame
    readings = feed(reader, garbage + 3 * frame(1), size)
    assert readings and all(reading == values(1) for reading in readings)


@given(strategies.integers(0, len(frame(0)) - 1), strategies.integers(1, 255))
def test_a_changed_byte_costs_one_frame(index, change):
    bad = bytearray(frame(2))
    bad[index] ^= change
    reader = FrameReader(MODEL, NUMBERS)
    assert reader.feed(frame(1) + bytes(bad) + frame(3)) == [values(1), values(3)]
    # a part of the frame may look like the beginning of another frame
    assert reader.rejected >= 1 and reader.skipped == len(bad)


@given(strategies.integers(0, len(frame(0)) - 1), strategies.booleans())
def test_a_lost_or_doubled_byte_costs_one_frame(index, lost):
    good = frame(2)
    bad = good[:index] + good[index + 1:] if lost else good[:index + 1] + good[index:]
    reader = FrameReader(MODEL, NUMBERS)
    readings = reader.feed(frame(1) + bad + frame(3))
    # a doubled header loses no frame
    assert readings in ([values(1), values(3)], [values(1), values(2), values(3)])
    assert reader.rejected >= 1


def test_a_value_out_of_range_is_no_reading():
    reader = FrameReader(MODEL, NUMBERS)
    assert reader.feed(protocol.encode_frame(MODEL, NUMBERS, dict(values(1), mode=5))) == []
    assert reader.rejected == 1


def reply(**changes):
    packets = protocol.single_packets(protocol.CREATE, sequences.QUERIED)
    reading = {**{packet.name: 0 for packet in packets}, 'voltage': 16000, **changes}
    return reading, protocol.packets_format(packets).pack(*(reading[packet.name] for packet in packets))


@pytest.mark.parametrize('size', [1, 3, 100])
def test_a_reply(size):
    reading, data = reply(distance=-7, analog_input=512)
    reader = ReplyReader(protocol.CREATE, sequences.QUERIED)
    reader.expect(sequences.QUERIED)
    assert feed(reader, data, size) == [reading]
    assert not reader.waiting


def test_a_reply_that_nobody_asked_for():
    reader = ReplyReader(protocol.CREATE, sequences.QUERIED)
    assert reader.feed(reply()[1]) == []
    reader.expect(sequences.QUERIED)
    assert reader.skipped == len(reply()[1])


@pytest.mark.parametrize('data', [reply()[1] + b'\0', reply(mode=5)[1], reply(voltage=0)[1], b'\0' + reply()[1][:-1]],
                         ids=['too long', 'mode', 'voltage', 'shifted'])
def test_a_corrupted_reply(data):
    reader = ReplyReader(protocol.CREATE, sequences.QUERIED)
    reader.expect(sequences.QUERIED)
    assert reader.feed(data) == []
    assert reader.rejected == 1 and not reader.waiting


def test_what_is_missing_of_a_frame():
    reader, data = FrameReader(MODEL, NUMBERS), frame(1)
    assert reader.missing == len(data)
    reader.feed(data[:10])
    assert reader.missing == len(data) - 10
    reader.clear()
    assert reader.missing == len(data) and reader.feed(frame(2)) == [values(2)]


def test_corrupted_bytes_between_two_good_frames_are_one_corrupted_frame():
    reader = FrameReader(MODEL, NUMBERS)
    reader.feed(bytes(5) + frame(1))
    assert (reader.rejected, reader.skipped) == (0, 5)      # the first frame may have begun before the first byte
    reader.feed(bytes(7))
    reader.feed(bytes(8) + frame(1))
    assert (reader.rejected, reader.skipped) == (1, 20)
    wrong = protocol.encode_frame(MODEL, NUMBERS, dict(values(1), mode=5))
    reader.feed(wrong + wrong + frame(1))
    assert (reader.rejected, reader.skipped) == (3, 20 + 2 * len(wrong))
    reader.clear()
    reader.feed(bytes(3) + frame(1))
    assert reader.rejected == 3


def test_a_byte_that_may_begin_a_frame_is_kept():
    reader = FrameReader(MODEL, NUMBERS)
    assert reader.feed(b'\0' + frame(1)[:1]) == [] and reader.skipped == 1
    assert reader.feed(frame(1)[1:]) == [values(1)] and reader.skipped == 1


def test_what_is_missing_of_a_reply():
    data = reply()[1]
    reader = ReplyReader(protocol.CREATE, sequences.QUERIED, sequences.QUERIED_WITHOUT_ANGLE)
    assert reader.missing == 0
    reader.expect(sequences.QUERIED)
    assert reader.missing == len(data)
    reader.feed(data[:4])
    assert reader.missing == len(data) - 4
    reader.expect(sequences.QUERIED_WITHOUT_ANGLE)
    # instead of group 2 (6 bytes), the distance (2 bytes)
    assert reader.missing == len(data) - 4 and reader.skipped == 4
    reader.clear()
    assert reader.missing == 0 and not reader.waiting and reader.skipped == 4


@pytest.mark.parametrize('voltage, good', [(4999, False), (5000, True), (25000, True), (25001, False)])
def test_the_voltage_of_a_reply(voltage, good):
    reader = ReplyReader(protocol.CREATE, sequences.QUERIED)
    reader.expect(sequences.QUERIED)
    assert bool(reader.feed(reply(voltage=voltage)[1])) == good == (reader.rejected == 0)
    assert reader.buffer == b'' and not reader.waiting
