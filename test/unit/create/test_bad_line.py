"""On a bad line, a reply of a Create may be corrupted undetected, so doubtful readings are rejected."""
import pytest

from rbx1_nav.create import protocol
from rbx1_nav.create.driver.fractions import KEPT, Fractions
from rbx1_nav.create.driver.travel import AGREED, STILL, CounterTravel, Expected, Implausible

PERIOD, WIDTH = 0.04, 0.26      # s, m
STEP = Expected(0.01, 0.01)     # m, in a period at 0.25 m/s


def read(counter, distance, expected=STEP, elapsed=PERIOD, angle=0):
    return counter.update({'distance': distance, 'angle': angle}, elapsed, expected)


def counter_after(losses=1, good=0):
    """Return a counter at a steady 0.25 m/s after lost replies and good readings."""
    counter = CounterTravel(protocol.CREATE, Fractions(KEPT))
    read(counter, 0)
    read(counter, 10)
    for _ in range(losses):
        counter.miss(True, 0.0, STILL)
    for _ in range(good):
        read(counter, 10)
    return counter


def test_a_good_line_is_not_doubted():
    assert read(counter_after(losses=0), 17) == pytest.approx((0.017, 0, 0, 0))


@pytest.mark.parametrize('number, expected, doubtful', [
    # 5 mm and 10 % of the expected travel are 6 mm
    (15, STEP, False), (17, STEP, True), (5, STEP, False), (3, STEP, True),
    # the wheels had 0.25 m/s and are commanded to stop: anything between 0 and 10 mm
    (-4, STILL, False), (-6, STILL, True), (14, STILL, False), (16, STILL, True)])
def test_a_reading_beyond_the_command_and_the_speed_before_is_rejected(number, expected, doubtful):
    counter = counter_after(good=1)
    if doubtful:
        with pytest.raises(Implausible, match=f'^distance: {number} mm, angle: 0 degrees in 0.040 s$'):
            read(counter, number, expected)
    else:
        assert read(counter, number, expected).distance == number / 1000


def test_an_angle_is_rejected_too():
    with pytest.raises(Implausible):
        read(counter_after(good=1), 10, angle=3)        # 6.8 mm at each wheel


def test_readings_that_are_rejected_again_and_again_are_true():
    counter = counter_after(good=1)
    for number in range(AGREED):
        with pytest.raises(Implausible):
            read(counter, 0, elapsed=PERIOD * (number + 1))     # the wheels are blocked
        counter.miss(True, PERIOD, STEP)
    travel = read(counter, 0, elapsed=PERIOD * (AGREED + 1))
    # three rejected readings are replaced by the commands, and this one may be corrupted, too
    assert travel.distance == pytest.approx(0.03)
    assert travel.distance_variance > 3 * (2 * 0.001 ** 2 / 4)


@pytest.mark.parametrize('good, rejected', [(14, True), (15, False)])
def test_after_one_loss_15_readings_are_doubted(good, rejected):
    """The share of lost replies is 1/50 and decreases by 1/50 with each reading: 0.98^14 / 50 = 0.0151."""
    counter = counter_after(good=good)
    if rejected:
        with pytest.raises(Implausible):
            read(counter, 17)
    else:
        assert read(counter, 17).distance == 0.017


def test_an_error_that_is_not_detected_has_a_variance():
    travel = read(counter_after(good=1), 10)
    # a share q of corrupted bytes loses 1 - (1 - q)^30 of the replies, and changes one of four bytes in 1 - (1 - q)^4;
    # up to 5 mm pass undetected, uniformly distributed
    share = 1 - (1 - 0.02 * 0.98) ** (4 / 30)
    assert travel.distance_variance == pytest.approx(share * 0.005 ** 2 / 3)
    assert travel.angle_variance == pytest.approx(share * (2 * 0.005 / WIDTH) ** 2 / 3)


def test_after_0_3_s_a_reading_cannot_be_compared():
    expected = Expected(0.25 * 0.31, 0.25 * 0.31)
    travel = read(counter_after(good=1), 92, expected, 0.31)
    assert travel.distance == 0.092
    # any error of the low byte
    assert travel.distance_variance == pytest.approx((1 - (1 - 0.02 * 0.98) ** (4 / 30)) * 0.128 ** 2 / 3)


@pytest.mark.parametrize('number', [20, 10])
def test_a_reading_may_include_the_travel_before_a_lost_query(number):
    counter = counter_after(good=1)
    counter.miss(False, PERIOD, STEP)
    assert read(counter, number, STEP, 2 * PERIOD).distance == pytest.approx(0.02)
