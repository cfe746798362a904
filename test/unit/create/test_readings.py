"""Replies are found in bytes that arrive in arbitrary pieces, and corrupted replies are counted and dropped."""
import pytest

from rbx1_nav.create import protocol
from rbx1_nav.create.driver import sequences
from rbx1_nav.create.driver.replies import ReplyReader


def feed(reader, data, size):
    """Return all readings in data that arrives in pieces."""
    readings = [reader.feed(data[start:start + size]) for start in range(0, len(data), size)]
    return [reading for reading in readings if reading]


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
    assert reader.feed(reply()[1]) is None
    reader.expect(sequences.QUERIED)
    assert reader.skipped == len(reply()[1])


@pytest.mark.parametrize('data', [reply()[1] + b'\0', reply(mode=5)[1], reply(voltage=0)[1], b'\0' + reply()[1][:-1]],
                         ids=['too long', 'mode', 'voltage', 'shifted'])
def test_a_corrupted_reply(data):
    reader = ReplyReader(protocol.CREATE, sequences.QUERIED)
    reader.expect(sequences.QUERIED)
    assert reader.feed(data) is None
    assert reader.rejected == 1 and not reader.waiting


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
