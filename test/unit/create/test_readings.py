"""Replies are found in bytes that arrive in arbitrary pieces, and corrupted replies are counted and dropped."""
import pytest

from rbx1_nav.create import protocol
from rbx1_nav.create.driver import sequences
from rbx1_nav.create.driver.exchange import Queries, Sender
from rbx1_nav.create.driver.fractions import KEPT, Fractions
from rbx1_nav.create.driver.motion import CounterTravel


def asked():
    """Return Queries that wait for a reply."""
    queries = Queries(Sender())
    queries.use(protocol.CREATE, CounterTravel(protocol.CREATE, Fractions(KEPT)))
    queries.ask(0)
    return queries


def reply(**changes):
    packets = protocol.single_packets(protocol.CREATE, sequences.QUERIED)
    reading = {**{packet.name: 0 for packet in packets}, 'voltage': 16000, **changes}
    return reading, protocol.packets_format(packets).pack(*(reading[packet.name] for packet in packets))


@pytest.mark.parametrize('size', [1, 3, 100])
def test_a_reply(size):
    reading, data = reply(distance=-7, analog_input=512)
    queries, found = asked(), []
    assert queries.missing == len(data)
    for start in range(0, len(data), size):
        found.append(queries.receive(0, data[start:start + size]))
        assert queries.missing == max(0, len(data) - start - size)
    assert found[-1] == reading and not any(found[:-1]) and not queries.waiting


@pytest.mark.parametrize('data', [reply()[1] + b'\0', reply(mode=5)[1], reply(voltage=0)[1], reply(voltage=25001)[1],
                                  b'\0' + reply()[1][:-1]],
                         ids=['too long', 'mode', 'no voltage', 'voltage', 'shifted'])
def test_a_corrupted_reply(data):
    queries = asked()
    assert queries.receive(0, data) is None
    assert queries.rejected == queries.missed == 1 and not queries.waiting
