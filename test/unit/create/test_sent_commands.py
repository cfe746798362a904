"""The wheel travel that was commanded, the lost replies, and the backlog of the line."""
import pytest

from rbx1_nav.create import protocol
from rbx1_nav.create.driver import sequences
from rbx1_nav.create.driver.commanded import Commanded
from rbx1_nav.create.driver.fractions import KEPT, LOST, Fractions
from rbx1_nav.create.driver.queries import Queries
from rbx1_nav.create.driver.sender import Sender
from rbx1_nav.create.driver.speeds import Rounding, is_too_fast
from rbx1_nav.create.driver.travel import STILL, EncoderTravel, travel_of
from rbx1_nav.units import SECOND


def tenths(count):
    return count * SECOND // 10


def test_speeds_count_from_their_command_to_the_next():
    commanded = Commanded()
    commanded.send(tenths(10), (100, -200))
    assert commanded.moving and commanded.counted == STILL
    commanded.send(tenths(20), (0, 300))
    commanded.advance(tenths(25))
    assert commanded.counted == commanded.since_reading == pytest.approx((0.1, -0.2 + 0.15))
    commanded.send(tenths(25), (0, 0))
    assert not commanded.moving
    commanded.advance(tenths(50))
    assert commanded.counted == pytest.approx((0.1, -0.05))


def test_a_clock_that_goes_back_takes_no_travel_back():
    commanded = Commanded()
    commanded.send(tenths(10), (100, 100))
    commanded.advance(tenths(20))
    commanded.advance(tenths(15))
    assert commanded.counted == pytest.approx((0.1, 0.1))


def test_the_robot_counts_from_the_query_and_the_rest_from_the_reading():
    commanded = Commanded()
    commanded.send(tenths(0), (100, 200))
    commanded.ask(tenths(10))
    assert commanded.asked == pytest.approx((0.1, 0.2)) and commanded.asked_time == tenths(10)
    commanded.advance(tenths(12))
    commanded.start(commanded.asked_time, commanded.asked)
    commanded.read()
    assert commanded.counted == pytest.approx((0.02, 0.04)) and commanded.counted_from == tenths(10)
    assert commanded.since_reading == STILL and commanded.asked == pytest.approx((0.1, 0.2))
    commanded.advance(tenths(22))
    assert commanded.counted == pytest.approx((0.12, 0.24)) and commanded.since_reading == pytest.approx((0.1, 0.2))


# the line

def make_sender():
    """Return (a Sender on a line at 10 bytes per second, the bytes that it sends)."""
    sender, sent = Sender(), []
    sender.byte = SECOND // 10
    sender.open(sent.append)
    return sender, sent


def test_a_line_is_busy_while_more_than_10_ms_of_bytes_wait():
    sender, _ = make_sender()
    sender.send(SECOND, b'abc')
    free = SECOND + tenths(3) - SECOND // 100
    assert sender.is_busy(free - 1) and not sender.is_busy(free)
    sender.send(SECOND, b'de')      # after the bytes that wait
    assert sender.is_busy(free + tenths(2) - 1) and not sender.is_busy(free + tenths(2))
    sender.send(3 * SECOND, b'f')
    assert sender.is_busy(3 * SECOND) and not sender.is_busy(3 * SECOND + tenths(1))


def test_after_an_error_the_line_is_not_used_until_it_is_opened_again():
    sender, sent = make_sender()
    error = OSError('disconnected')

    def fail(_):
        raise error
    sender.open(fail)
    sender.send(0, b'a')
    assert sender.error is error and sender.write is None
    sender.send(0, b'b')
    sender.open(sent.append)
    assert sender.error is None
    sender.send(0, b'c')
    sender.close()
    sender.send(0, b'd')
    assert sent == [b'c']


def test_bytes_without_a_line_do_not_occupy_it():
    sender, _ = make_sender()
    sender.close()
    sender.send(0, b'abc')
    assert not sender.is_busy(0)


def test_a_stop_is_sent_between_other_bytes_and_clears_the_rounding_error():
    sender, sent = make_sender()
    sender.drive(0, (0.9, 0.9))
    sender.drive(tenths(9), (0.9, 0.9))
    sender.stop(tenths(9), b'a')
    assert sent[-1] == b'a' + sequences.STOP and sender.commanded.speeds == (0, 0)
    sender.stop(tenths(9), after=b'z')
    assert sent[-1] == b'z'
    # 0.81 mm were missing
    sender.drive(tenths(9), (0.1, 0.1))
    assert sent[-1] == protocol.drive_direct(0, 0)


def test_each_wheel_gets_its_speed_and_its_rounding():
    sender, sent = make_sender()
    sender.drive(0, (100.25, -50.25))
    assert sent[-1] == protocol.drive_direct(-51, 100) and sender.commanded.speeds == (100, -51)
    sender.drive(tenths(1), (100.25, -50.25))
    assert sent[-1] == protocol.drive_direct(-50, 101)
    # 1 mm/s too fast for 10 ms does not make up for 0.25 mm/s too slow for 100 ms
    sender.drive(SECOND * 11 // 100, (100.25, -50.25))
    assert sent[-1] == protocol.drive_direct(-50, 101)


def test_a_rounding_error_counts_for_a_second_at_most():
    rounding = Rounding()
    assert rounding.next(10.5, 0.0) == 10
    # the command expired: it is 0.5 mm behind, and not 5 mm
    assert rounding.next(10.5, 10.0) == 11
    assert rounding.next(10.5, 0.9) == 11 and rounding.next(10.5, 0.2) == 10


def test_the_speed_limit_of_a_wheel_is_500_mm_s():
    assert not is_too_fast(0.5, 0.0, 0.26) and is_too_fast(-0.501, 0.0, 0.26)
    assert not is_too_fast(0.37, -1.0, 0.26) and is_too_fast(0.371, -1.0, 0.26)


# queries

def queries(model=protocol.CREATE, kind=KEPT):
    """Return (Queries to a robot, its Counter, the lost replies)."""
    sender, losses = Sender(), []
    result = Queries(sender)
    result.sent = []
    sender.open(result.sent.append)
    counter = travel_of(model, Fractions(kind))
    counter.miss = lambda *arguments: losses.append(arguments)
    result.use(model, counter)
    return result, losses


def test_a_reply_is_awaited_for_0_2_s_and_its_next_byte_for_50_ms():
    result, _ = queries()
    assert not result.awaits_reply(SECOND)
    result.ask(SECOND)
    assert result.awaits_reply(SECOND * 6 // 5 - 1) and not result.awaits_reply(SECOND * 6 // 5)
    result.reader.feed(b'\0')
    result.byte_time = 2 * SECOND
    assert result.awaits_reply(2 * SECOND + SECOND // 20 - 1) and not result.awaits_reply(2 * SECOND + SECOND // 20)


@pytest.mark.parametrize('begun', [False, True])
def test_a_query_gives_up_the_previous_one(begun):
    result, losses = queries()
    result.sender.commanded.send(0, (100, 200))
    result.ask(tenths(1))
    assert result.missed == 0
    result.reader.feed(b'\0' * begun)
    result.ask(tenths(3))
    assert result.missed == 1 and not result.reader.buffer
    assert losses == [(begun, 0.1, pytest.approx((0.01, 0.02)))]
    # the robot counts from the lost query on
    commanded = result.sender.commanded
    assert commanded.counted == pytest.approx((0.02, 0.04)) and commanded.counted_from == tenths(1)
    result.give_up()
    assert result.missed == 2 and losses[1] == (False, 0.2, pytest.approx((0.02, 0.04)))
    result.give_up()
    assert result.missed == 2


def test_what_a_robot_is_asked_for():
    all_packets, no_angle = sequences.query(sequences.QUERIED), sequences.query(sequences.QUERIED_WITHOUT_ANGLE)
    result, _ = queries(kind=LOST)
    result.ask(0, start=True)
    result.ask(0)
    assert result.sent == [sequences.STOP + sequences.START + all_packets, no_angle]
    for model, query in (protocol.CREATE, all_packets), (protocol.CREATE_2, sequences.query((1, 3, 34, 35, 43, 44))):
        result, _ = queries(model)
        result.ask(0)
        assert result.sent == [query]
    assert isinstance(travel_of(protocol.CREATE_2, Fractions()), EncoderTravel)


def test_the_queries_of_the_document():
    """Groups 1 and 3, charging sources, mode, and group 2 with distance and angle, or the distance alone; analog input:
    query list (149) with 6 packets."""
    assert sequences.query(sequences.QUERIED) == bytes((149, 6, 1, 3, 34, 35, 2, 33))
    assert sequences.query(sequences.QUERIED_WITHOUT_ANGLE) == bytes((149, 6, 1, 3, 34, 35, 19, 33))
    assert sequences.PAUSE_STREAM == bytes((150, 0))
    assert sequences.ASK_BATTERY == bytes((128, 142, 3))
    assert sequences.ASK_ENCODER + sequences.ASK_WALL == bytes((142, 43, 142, 8))
    # an encoder has two bytes, so zeros complete the longest command of the driver before a stop
    assert sequences.STOP == bytes(7) + bytes((145, 0, 0, 0, 0))
    assert sequences.FLUSH == bytes(512)


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
