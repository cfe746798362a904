"""What the exercise without ROS consists of: its motions and pauses."""
from itertools import groupby
import os

import pytest

from rbx1_nav.base.robot_parameters import load_robot
from rbx1_nav.extras.many_runs.simulated_run import PARAMETERS, simulate

TURTLEBOT = load_robot(os.path.join(os.path.dirname(__file__), '..', '..', '..', '..', 'config', 'turtlebot.yaml'))


def standstills(run):
    """Return for how many ticks the robot of a run was stationary, each time."""
    lengths = [len(list(same)) for _, same in groupby(snapshot.truth for snapshot in run.path)]
    # the tick in which the robot arrives, except at the origin
    return [lengths[0], *(length - 1 for length in lengths[1:] if length > 1)]


def test_the_timed_exercise_takes_as_long_as_its_motions_and_pauses():
    run = simulate('timed', TURTLEBOT, None, 0, keep=True)
    # 2 s for the calibration, 1 m at 0.2 m/s and pi at 1 rad/s twice, and 1 s after each motion
    assert standstills(run) == [100, 50, 50, 50, 50]
    assert len(run.path) == 100 + 2 * (250 + 157) + 4 * 50
    assert run.path[0].time == pytest.approx(0.02) and run.end == run.path[-1]
    assert run.end.time == pytest.approx(len(run.path) / 50)
    assert run.first_leg == pytest.approx(1.0)
    assert run.covariance is None and run.end.estimate is None


@pytest.mark.parametrize('method', ['odom', 'ekf'])
def test_each_leg_has_a_trial_stop_of_half_a_second(method):
    run = simulate(method, TURTLEBOT, None, 0, keep=True)
    assert standstills(run) == [100] + [25, 50] * 4
    # half of the slowest travel per tick, 0.5 mm, for odometry that is exact
    assert run.first_leg == pytest.approx(1.0, abs=0.00051)
    assert (run.covariance is not None) is (run.end.estimate is not None) is (method == 'ekf')


def test_who_listens_is_called_at_each_tick_and_receives_the_readings_of_the_base():
    heard = []
    run = simulate('timed', TURTLEBOT, None, 0, keep=True, listen=lambda *each: heard.append(each))
    assert [snapshot for snapshot, _ in heard] == run.path
    for snapshot, messages in heard[::50]:
        assert messages.odom.stamp == messages.imu.stamp == round(snapshot.time * 1e9)
        assert messages.odom.pose == snapshot.odometry
        assert messages.orientation == pytest.approx((snapshot.truth.yaw, 1e-6))
        assert messages.pose_variances == (1e-6,) * 3
    assert {round(messages.imu.rate, 9) for _, messages in heard} == {0.0, 1.0}


def test_the_parameters_of_the_driving_scripts_apply():
    run = simulate('timed', TURTLEBOT, None, 0, keep=True, parameters=dict(PARAMETERS, linear_speed=0.1, rate=20))
    # the pauses have the same duration; a turn takes pi seconds, rounded down to ticks of 50 ms
    assert standstills(run) == [40, 20, 20, 20, 20]
    assert len(run.path) == 40 + 2 * (200 + 62) + 4 * 20
    assert run.first_leg == pytest.approx(1.0)
