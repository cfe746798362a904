"""Past yaws of the filter are interpolated."""
import pytest

from rbx1_nav.estimation.turns import PastYaws


def past(*yaws):
    """Return PastYaws with these (time, yaw)."""
    result = PastYaws()
    for time, yaw in yaws:
        result.add(time, yaw)
    return result


@pytest.mark.parametrize('time, yaw', [(100, 1.0), (125, 1.5), (200, 3.0), (250, 2.0), (300, 1.0)])
def test_a_yaw_between_two_times_is_interpolated(time, yaw):
    assert past((100, 1.0), (200, 3.0), (300, 1.0)).take(time) == pytest.approx(yaw)


def test_odometry_may_ask_again_for_the_same_or_a_later_time():
    yaws = past((100, 1.0), (200, 3.0), (300, 1.0), (400, 5.0))
    assert [yaws.take(time) for time in (150, 200, 200, 210, 350, 350, 400)] == pytest.approx(
        [2.0, 3.0, 3.0, 2.8, 3.0, 3.0, 5.0])


def test_a_turn_of_the_frame_turns_all_yaws():
    yaws = past((100, 1.0), (200, 3.0), (300, 1.0))
    yaws.turn(0.5)
    yaws.add(400, 7.5)
    assert [yaws.take(time) for time in (100, 150, 250, 350)] == pytest.approx([1.5, 2.5, 2.5, 4.5])
