"""Whether a robot loses fractions of a degree is decided by comparing frequent with rare readings of a steady turn."""
import pytest

from rbx1_nav.create.driver.fractions import AUTO, KEPT, LOST, Fractions, fraction

PERIOD = 1 / 32     # s between two readings: sums of this number are exact
TURN = 2.0          # degrees between two readings


class Turning:
    """A robot in a steady turn, with fractions that it may lose (degrees, on average)."""

    def __init__(self, kind=AUTO, side=1):
        self.log = []
        self.fractions = Fractions(kind, self.log.append)
        self.side = side
        self.total = 0.0    # degrees returned and made up

    def read(self, read, times=1, commanded=TURN, elapsed=PERIOD):
        """Feed equal readings, both in degrees to the side."""
        for _ in range(times):
            self.total += self.side * self.fractions.add(self.side * commanded, self.side * read, elapsed)

    def read_until_coarse(self, read, limit=200, commanded=TURN):
        """Feed equal readings. Returns their number up to a suspicion; None without one."""
        for number in range(1, limit + 1):
            self.read(read, commanded=commanded)
            if self.fractions.coarse:
                return number
        return None

    def make_up(self):
        """Add what is made up in 100 updates. Returns the largest part."""
        parts = [self.side * self.fractions.make_up() for _ in range(100)]
        self.total += sum(parts)
        return max(parts)


def test_the_expected_loss():
    assert [fraction(turn) for turn in (0.0, 0.3, 0.99, 1.0, 1.5, 7.0)] == [0.0, 0.3, 0.99, 0.5, 0.5, 0.5]


@pytest.mark.parametrize('side', [1, -1])
def test_everything_that_was_lost_is_made_up(side):
    robot = Turning(side=side)
    robot.read(1.5, 16)     # 0.5 s, in which the robot may lag
    assert robot.make_up() == 0
    assert robot.read_until_coarse(1.5) == 12       # 12 losses of 0.5 degrees
    robot.read(13.5, 2, 14.0, 0.25)
    assert robot.fractions.kind == AUTO and not robot.log
    assert robot.make_up() == 0     # nothing is corrected before the decision
    robot.read(13.5, 1, 14.0, 0.25)     # 42 degrees
    assert robot.fractions.kind == LOST and len(robot.log) == 1
    # 14.5 degrees in parts of 2, which a filter does not mistake for a change of place
    assert robot.make_up() == 2.0
    assert robot.total == pytest.approx(16 * 2 + 12 * 2 + 3 * 14)
    # from now on, each reading that is not 0 is corrected by its mean loss
    robot.read(13.5, 4, 14.0, 0.25)
    robot.read(0.0, 4, 0.0)
    assert robot.make_up() == 0.0 and robot.total == pytest.approx(7 * 14 + 28 * 2)


def test_the_lag_at_the_start_of_a_turn_is_no_loss():
    robot = Turning()
    robot.read(0.5, 16)
    robot.read_until_coarse(1.5)
    robot.read(13.5, 3, 14.0, 0.25)
    robot.make_up()
    # 0.5 degrees for each reading at the start
    assert robot.total == pytest.approx(16 * (0.5 + 0.5) + 12 * 2 + 3 * 14)


def test_a_start_that_lost_nothing_is_not_corrected():
    robot = Turning()
    robot.read(2.0, 16)
    robot.read(1.5, 11)
    assert robot.make_up() == 0
    robot.read(1.5)
    robot.read(9.5, 4, 10.0, 10 / 64)      # 40 degrees are enough
    assert robot.fractions.kind == LOST
    robot.make_up()
    assert robot.total == pytest.approx(16 * 2 + 12 * 2 + 4 * 10)


def test_two_readings_at_the_same_time():
    assert Fractions().add(0.0, 0, 0.0) == 0


def test_the_lag_at_the_start_raises_no_suspicion():
    robot = Turning()
    robot.read(0.0, 16)     # 0.5 s
    assert robot.read_until_coarse(2.0) is None


@pytest.mark.parametrize('fine, kind', [(20.8, KEPT), (20.3, LOST)])
def test_the_decision_is_the_closer_of_both_explanations(fine, kind):
    """If fractions are kept, 24 degrees yield 24 * 40.5 / 42 = 23.1; if they are lost, 24 - 12 / 2 = 18. The mean is
    20.6."""
    robot = Turning()
    robot.read(1.5, 16)
    assert robot.read_until_coarse(fine / 12) == 12
    robot.read(13.5, 3, 14.0, 0.25)
    assert robot.fractions.kind == kind
    # a robot that keeps fractions is asked for its angle each time
    assert robot.fractions.coarse == (kind == LOST) and len(robot.log) == (kind == LOST)


def test_wheels_that_slip_lose_no_fractions():
    robot = Turning()
    robot.read(1.5, 16)
    assert robot.read_until_coarse(1.5) == 12
    robot.read(10.5, 3, 14.0, 0.25)
    assert robot.fractions.kind == KEPT
    before = robot.total
    robot.read(1.5)
    assert robot.make_up() == 0.0 and robot.total == before + 1.5


def test_a_suspicion_requires_15_degrees_and_6_lost_degrees():
    # 0.75 degrees may be lost entirely: 20 readings are 15 degrees; of 3 degrees, half a degree is expected to be lost
    for commanded, count in ((0.75, 20), (3.0, 12)):
        robot = Turning()
        robot.read(commanded, 16, commanded)
        assert robot.read_until_coarse(0.0, commanded=commanded) == count


def test_a_loss_of_less_than_half_of_what_is_expected_is_not_suspicious():
    # 0.5 degrees of each reading are expected
    robot = Turning()
    robot.read(2.0, 16)
    assert robot.read_until_coarse(1.76) is None
    robot = Turning()
    robot.read(2.0, 16)
    assert robot.read_until_coarse(1.74) == 12


def test_readings_that_were_large_enough_are_forgotten_after_90_degrees():
    robot = Turning()
    robot.read(2.0, 16)
    assert robot.read_until_coarse(2.0, 45) is None     # 90 degrees
    robot.read(2.0)     # more than 90 degrees
    assert robot.read_until_coarse(1.5) == 12


def test_readings_up_to_90_degrees_are_compared_together():
    robot = Turning()
    robot.read(2.0, 16)
    assert robot.read_until_coarse(2.0, 30) is None
    # more than half of the expected loss: 2 n > (30 + n) / 4
    assert robot.read_until_coarse(0.0) == 5


@pytest.mark.parametrize('factor, restarts', [(1.2, False), (0.84, False), (1.3, True), (0.8, True)])
def test_a_change_of_the_rate_by_more_than_a_fifth_restarts_the_comparison(factor, restarts):
    robot = Turning()
    robot.read(2.0, 16)
    robot.read(1.0, 5)
    found = robot.read_until_coarse(1.0, commanded=2 * factor)
    # after a change, the robot may lag for 0.5 s
    assert found == (16 + 12 if restarts else 12 - 5)


def test_a_turn_to_the_other_side_restarts_the_comparison():
    robot = Turning()
    robot.read(2.0, 16)
    robot.read(1.0, 11)
    robot.side = -1
    assert robot.read_until_coarse(1.0) == 16 + 12


def test_missing_readings_restart_the_comparison():
    for elapsed, restarts in ((2.4, False), (2.6, True)):
        robot = Turning()
        robot.read(2.0, 16)
        robot.read(1.0, 5)
        robot.read(1.0 * elapsed, 1, 2.0 * elapsed, PERIOD * elapsed)
        robot.fractions.add(2.0, 1.0, PERIOD)
        assert (robot.read_until_coarse(1.0) > 12) == restarts
    robot = Turning()
    robot.read(2.0, 16)
    robot.read(1.0, 11)
    robot.fractions.disturb()
    assert robot.read_until_coarse(1.0) == 16 + 12


def test_a_known_robot_is_not_compared():
    robot = Turning(KEPT)
    assert robot.read_until_coarse(1.0) is None and robot.total == 200 and robot.make_up() == 0
    robot = Turning(LOST)
    robot.read(1.0, 10)
    robot.read(0.0, 10)
    # a reading of 0 may have lost anything below a degree, so only the others are corrected
    assert robot.total == 15 and robot.make_up() == 0 and not robot.log


def test_negative_readings_are_corrected_in_their_direction():
    fractions = Fractions(LOST)
    assert fractions.add(-5.0, -4, 0.25) == -4.5 and fractions.add(5.0, -1, 0.25) == -1.5


@pytest.mark.parametrize('turn, time, due', [
    (13.9, 0.0, False), (14.0, 0.0, True), (-13.9, 0.0, False), (-14.0, 0.0, True), (0.0, 0.89, False),
    (0.0, 0.9, True)])
def test_the_angle_is_read_after_14_degrees_or_0_9_s(turn, time, due):
    assert Fractions(LOST).is_due(turn, time) == due
    assert Fractions(KEPT).is_due(0.0, 0.0) and Fractions(AUTO).is_due(0.0, 0.0)


def test_the_interval_varies_by_up_to_30_percent():
    """With equal intervals, each could lose the same fraction."""
    fractions = Fractions(LOST)
    limits = []
    for _ in range(200):
        limits.append(next(turn for turn in range(1000) if fractions.is_due(turn / 10, 0.0)) / 10)
        fractions.add(14.0, 13, 0.25)
    assert min(limits) == 14.0 and 18.0 < max(limits) <= 18.2
    # spread evenly: within the standard error of the mean, and in each quarter of the range
    assert sum(limits) / 200 == pytest.approx(16.1, abs=0.1)
    assert all(40 < sum(low <= limit < low + 1.05 for limit in limits) < 60 for low in (14, 15.05, 16.1, 17.15))
