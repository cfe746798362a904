"""The bytes and speeds that are sent to the robot, the travel that they command, and queries without a reply."""
import pytest

from rbx1_nav.create import protocol
from rbx1_nav.create.driver import sequences
from rbx1_nav.create.driver.exchange import Queries, Sender
from rbx1_nav.create.driver.fractions import KEPT, LOST, Fractions
from rbx1_nav.create.driver.motion import STILL, CounterTravel, EncoderTravel
from rbx1_nav.units import SECOND


def tenths(count):
    return count * SECOND // 10


def make_sender():
    """Return (a Sender on a line at 10 bytes per second, the bytes that it sends)."""
    sender, sent = Sender(), []
    sender.byte = SECOND // 10
    sender.use_line(sent.append)
    return sender, sent


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


def test_a_line_is_busy_while_bytes_wait():
    sender, _ = make_sender()
    sender.send(SECOND, b'abc')
    assert sender.is_busy(SECOND) and not sender.is_busy(SECOND + tenths(3))
    sender.send(SECOND, b'de')      # after the bytes that wait
    assert sender.is_busy(SECOND + tenths(4)) and not sender.is_busy(SECOND + tenths(5))
    sender.use_line(None)
    sender.send(3 * SECOND, b'f')   # without a line
    assert not sender.is_busy(3 * SECOND)


def test_after_an_error_the_line_is_not_used_until_it_is_opened_again():
    sender, sent = make_sender()
    error = OSError('disconnected')

    def fail(_):
        raise error
    sender.use_line(fail)
    sender.send(0, b'a')
    assert sender.error is error and sender.write is None
    sender.send(0, b'b')
    sender.use_line(sent.append)
    assert sender.error is None
    sender.send(0, b'c')
    assert sent == [b'c']


# queries

def queries(model=protocol.CREATE, kind=KEPT):
    """Return (Queries to a robot, what they send)."""
    sender, sent = Sender(), []
    sender.use_line(sent.append)
    result = Queries(sender)
    result.use(model, EncoderTravel(model) if model.counts_per_metre else CounterTravel(model, Fractions(kind)))
    return result, sent


def test_a_query_gives_up_the_previous_one():
    result, _ = queries()
    result.sender.drive(0, (100, 200))
    result.ask(tenths(1))
    assert result.awaits_reply(tenths(1)) and result.missed == 0
    assert result.receive(tenths(2), bytes(result.missing - 1)) is None
    assert not result.awaits_reply(tenths(3))
    result.ask(tenths(3))
    assert result.missed == 1 and not result.buffer
    result.give_up()
    assert result.missed == 2
    result.give_up()
    assert result.missed == 2


def test_a_reading_has_a_time_and_a_commanded_travel():
    result, _ = queries(protocol.CREATE_2)
    result.sender.drive(0, (100, 200))
    result.ask(tenths(1))
    assert result.since_reading() == (0.0, STILL)
    result.accept()
    result.ask(tenths(2))
    result.ask(tenths(4))       # the reply to the query before was lost
    assert result.since_reading() == (pytest.approx(0.3), pytest.approx((0.03, 0.06)))


def test_a_robot_that_drops_fractions_is_not_asked_for_its_angle_each_time():
    result, sent = queries(kind=LOST)
    result.ask(0)
    result.counter.first = False
    result.ask(0)
    assert sent == [sequences.query(sequences.QUERIED), sequences.query(sequences.QUERIED_WITHOUT_ANGLE)]


def test_the_queries_of_the_document():
    """Groups 1 and 3, charging sources, mode, and group 2 with distance and angle, or the distance alone; analog input:
    query list (149) with 6 packets. A Create 2 has encoders (43, 44)."""
    assert sequences.query(sequences.QUERIED) == bytes((149, 6, 1, 3, 34, 35, 2, 33))
    assert sequences.query(sequences.QUERIED_WITHOUT_ANGLE) == bytes((149, 6, 1, 3, 34, 35, 19, 33))
    assert sequences.query(sequences.queried(protocol.CREATE_2)[0]) == bytes((149, 6, 1, 3, 34, 35, 43, 44))


def test_how_a_robot_is_left():
    create, create_2 = protocol.CREATE, protocol.CREATE_2
    assert sequences.leave(create) == sequences.STOP + bytes((147, 0, 128))
    assert sequences.leave(create_2) == sequences.STOP + bytes((128,))
    for model in create, create_2:
        assert sequences.guardian_stop(model) == sequences.leave(model) + bytes(512) + sequences.leave(model)


@pytest.mark.parametrize('mode, opcode', [(1, 128), (2, 131), (3, 132)])
def test_how_control_is_taken(mode, opcode):
    """Digital output 0 (147 1) switches on the power of the TurtleBot's sensors, unless the robot is not driven."""
    output = b'' if mode == 1 else bytes((147, 1))
    assert sequences.take_control(protocol.CREATE, mode) == bytes((opcode,)) + output
    assert sequences.take_control(protocol.CREATE_2, mode) == bytes((opcode,))
