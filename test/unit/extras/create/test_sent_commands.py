"""What is sent to the robot, its wheel speeds and travel, and replies that arrive in pieces or corrupted."""
from hypothesis import given, strategies
import pytest

from rbx1_nav.base.units import SECOND
from rbx1_nav.extras.create import protocol, sequences
from rbx1_nav.extras.create.angle_fractions import KEPT, Fractions
from rbx1_nav.extras.create.odometry import STILL, CounterTravel, EncoderTravel
from rbx1_nav.extras.create.queries import Queries
from rbx1_nav.extras.create.sender import Phase, Sender, is_too_fast, wheel_speeds


def tenths(count):
    return count * SECOND // 10


def make_sender():
    """Return (a Sender on a line, the bytes that it sends)."""
    sender, sent = Sender(), []
    sender.use_line(sent.append)
    sender.phase = Phase.DRIVEN
    return sender, sent


def asked(model=protocol.CREATE):
    """Return Queries that wait for a reply."""
    queries = Queries(make_sender()[0])
    queries.use(model, EncoderTravel(model) if model.counts_per_metre else CounterTravel(model, Fractions(KEPT)))
    queries.ask(0)
    return queries


def test_speeds_count_from_their_command_to_the_next():
    sender, sent = make_sender()
    sender.drive(tenths(10), (100.4, -199.6))
    assert sent == [protocol.drive_direct(-200, 100)] and sender.speeds == (100, -200)
    assert sender.travel(tenths(10)) == STILL
    sender.drive(tenths(20), (0, 300))
    assert sender.travel(tenths(25)) == pytest.approx((0.1, -0.2 + 0.15))
    # a clock that goes back takes no travel back
    assert sender.travel(tenths(24)) == pytest.approx((0.1, -0.05))
    sender.stop(tenths(24))
    assert sent[-1] == sequences.STOP
    assert sender.travel(tenths(50)) == pytest.approx((0.1, -0.05))


def test_a_reading_has_a_time_and_a_commanded_travel():
    queries = asked(protocol.CREATE_2)
    queries.sender.drive(0, (100, 200))
    queries.give_up()
    queries.ask(tenths(1))
    assert queries.since_reading() == (0.0, STILL)
    queries.accept(tenths(1))
    queries.give_up()
    queries.ask(tenths(2))
    queries.give_up()
    queries.ask(tenths(4))
    assert queries.since_reading() == (pytest.approx(0.3), pytest.approx((0.03, 0.06)))


SPEEDS = strategies.floats(-10, 10)


@given(SPEEDS, SPEEDS)
def test_the_limit_does_not_bend_the_curve(linear, angular):
    left, right = wheel_speeds(linear, angular, 0.26)
    assert max(abs(left), abs(right)) <= 500.001
    assert is_too_fast(linear, angular, 0.26) == (abs(linear) + 0.13 * abs(angular) > 0.5)
    # the ratio of the speeds determines the curvature
    asked_left, asked_right = linear - 0.13 * angular, linear + 0.13 * angular
    assert left * asked_right == pytest.approx(right * asked_left, abs=1e-6)


def test_below_the_limit_nothing_changes():
    assert wheel_speeds(0.2, 1.0, 0.26) == pytest.approx((70, 330))


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
