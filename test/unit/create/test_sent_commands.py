"""The bytes and speeds that are sent to the robot, the travel that they command, and queries without a reply."""
import pytest

from rbx1_nav.create import protocol
from rbx1_nav.create.driver import sequences
from rbx1_nav.create.driver.exchange import Queries, Sender
from rbx1_nav.create.driver.fractions import KEPT, Fractions
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


# queries

def queries(model=protocol.CREATE, kind=KEPT):
    """Return (Queries to a robot, what they send)."""
    sender, sent = Sender(), []
    sender.use_line(sent.append)
    result = Queries(sender)
    result.use(model, EncoderTravel(model) if model.counts_per_metre else CounterTravel(model, Fractions(kind)))
    return result, sent


def test_a_reading_has_a_time_and_a_commanded_travel():
    result, _ = queries(protocol.CREATE_2)
    result.sender.drive(0, (100, 200))
    result.ask(tenths(1))
    assert result.since_reading() == (0.0, STILL)
    result.accept()
    result.ask(tenths(2))
    result.ask(tenths(4))       # the reply to the query before was lost
    assert result.since_reading() == (pytest.approx(0.3), pytest.approx((0.03, 0.06)))
