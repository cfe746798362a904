"""The line between host and robot: its rate, wrong baud rates, corrupted bytes."""
import pytest
from hypothesis import given
from hypothesis import strategies as st

from rbx1_nav.base.units import SECOND
from rbx1_nav.extras.create.emulator.serial_line import SerialLine, misread
from rbx1_nav.extras.create.protocol import BAUD_RATES

rates = st.sampled_from(BAUD_RATES)


@given(st.binary(), st.floats(0.965, 1.035))
def test_a_receiver_tolerates_a_clock_that_is_a_little_off(data, ratio):
    # half a bit in 9.5 bits is 5 %, and the previous bit must be over
    assert misread(data, 57600 * ratio, 57600) == data


def test_what_a_receiver_at_half_and_at_double_the_rate_reads():
    # 0111111111 on the line, each bit read twice: start bit and a 0
    assert misread(b'\xff', 57600, 115200) == b'\xfe'
    # 0000000001 on the line, every other bit read from the fourth on
    assert misread(b'\x00', 115200, 57600) == b'\xf8'


@given(st.binary(max_size=500), rates)
def test_bytes_take_their_time(data, baud):
    line = SerialLine(baud)
    line.from_robot(data, 1000)
    period = 10 * SECOND // baud
    for count in range(0, len(data), 50):
        assert line.received(1000 + count * period) == data[max(0, count - 50):count]
    assert line.received(1000 + len(data) * period) == data[(len(data) - 1) // 50 * 50 if data else 0:]


@given(st.binary(min_size=1, max_size=100))
def test_bytes_to_the_robot_take_their_time(data):
    line = SerialLine(57600)
    line.from_host(data[:1], 0)
    line.from_host(data[1:], 0)     # these bytes must wait for the first byte
    times = []
    for byte in data:
        times.append(line.next_to_robot)
        assert line.receive_byte() == byte
    assert times == [(index + 1) * (10 * SECOND // 57600) for index in range(len(data))]
    assert line.next_to_robot is None


@pytest.mark.parametrize('fraction', [0.0, 0.01, 0.3, 1.0])
def test_the_fraction_of_corrupted_bytes(fraction):
    line = SerialLine(115200, 7)
    line.corruption = fraction
    counts = {}
    for index in range(20000):
        line.from_robot(b'\x55', index * SECOND)
        received = line.received((index + 1) * SECOND)
        kind = {0: 'lost', 2: 'doubled'}.get(len(received), 'intact' if received == b'\x55' else 'flipped')
        assert kind != 'flipped' or bin(received[0] ^ 0x55).count('1') == 1
        counts[kind] = counts.get(kind, 0) + 1
    for kind in 'lost', 'doubled', 'flipped':
        # five standard deviations of a binomial distribution
        assert abs(counts.get(kind, 0) - 20000 * fraction / 3) <= 5 * (20000 * fraction / 3) ** 0.5


def test_what_waits_when_the_rate_changes_leaves_at_the_new_one():
    line, slow, fast = SerialLine(57600), 10 * SECOND // 1200, 10 * SECOND // 57600
    line.host_baud = 1200
    line.from_host(b'\x00\x01\x02\x03', 0)
    line.host_baud = 57600
    line.from_host(b'\x04', 3 * slow // 2)         # the second byte is being sent
    arrived = []
    while line.next_to_robot is not None:
        arrived.append((line.next_to_robot, line.receive_byte()))
    assert arrived[-3:] == [(2 * slow + index * fast, byte) for index, byte in enumerate((2, 3, 4), 1)]
    assert all(time <= 2 * slow for time, _ in arrived[:-3])


def test_1024_bytes_wait_to_be_sent_and_the_next_are_lost():
    line, period = SerialLine(57600), 10 * SECOND // 57600
    line.from_robot(bytes(1000), 0)
    line.from_robot(b'a' * 30, 0)
    line.from_robot(b'b', 0)
    line.from_robot(b'c' * 30, 10 * period)     # ten bytes have left
    assert line.received(SECOND) == bytes(1000) + b'a' * 24 + b'c' * 10
    assert line.next_to_host is None
