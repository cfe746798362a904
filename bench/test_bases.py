"""The evaluation of the filter on other projects' bases: its messages, dead reckoning, and its figures."""
import math

import numpy
import pytest

import bases
from base_cases import CASES, Case
import replay
import simulated

ROBOT = simulated.robot()
GOOD = dict(case='a', heading=1.0, port_heading=2.0, reckoned_heading=1.0, position=0.1, port_position=0.1,
            reckoned_position=0.1, wheels_heading=3.0, wheels_position=0.2, nees=3.0, claimed=2.0)
IDEAL = Case('ideal', 'ideal')


@pytest.mark.parametrize('seed', range(6))      # each path, turning to both sides
def test_dead_reckoning_is_exact_without_errors(seed):
    record = bases.drive(ROBOT, IDEAL, None, seed)
    assert replay.reckon(record, bases.rest_of(3.0))[-1] == pytest.approx(record.truth[-1], abs=1e-9)       # rounding
    assert max(abs(pose.yaw) for pose in record.truth) > 1.0


def test_dead_reckoning_and_port_have_the_heading_of_an_imu_at_another_rate():
    record = bases.drive(ROBOT, IDEAL._replace(odom_rate=25, imu_rate=100), None, 0)
    assert replay.reckon(record, bases.rest_of(3.0))[-1][2] == pytest.approx(record.truth[-1].yaw, abs=1e-9)
    difference = replay.run_port(record)[-1][2] - record.truth[-1].yaw
    assert math.remainder(difference, 2 * math.pi) == pytest.approx(0, abs=1e-6)


def test_the_gyro_has_the_scale_error_of_the_case():
    case = CASES['scale_circle']
    exact, scaled = ([imu.rate for imu, _ in bases.drive(ROBOT, case._replace(scale=scale), simulated.floor(case.floor),
                                                         0).imu] for scale in (0.0, 0.1))
    assert max(abs(other - rate) for rate, other in zip(exact, scaled)) > 0.02


def test_the_messages_have_the_rates_the_bias_and_the_variances_of_the_case():
    case = CASES['husky']._replace(drift=0.5)
    record = bases.drive(ROBOT, case, simulated.floor(case.floor), 0)
    (first, variances), (last, _) = record.odom[0], record.odom[-1]
    duration = (last.stamp - first.stamp) / bases.SECOND
    assert len(record.odom) == pytest.approx(10 * duration, abs=1.5)
    assert len(record.imu) == pytest.approx(30 * duration, abs=1.5)
    assert variances == (0.001, 0.001, 0.03)
    assert record.imu[0][0].variance == 4e-4 and record.imu[0][1][1] == 1.225e-3
    # both at rest; 0.1 degrees/s of noise in 30 readings
    for readings, bias in (record.imu[:30], 1.0), (record.imu[-30:], 1.0 + 0.5 * duration / 60):
        assert math.degrees(numpy.mean([imu.rate for imu, _ in readings])) == pytest.approx(bias, abs=0.06)


def test_an_estimate_that_stays_behind_is_compared_with_the_truth_of_now():
    record = bases.drive(ROBOT, IDEAL, None, 0)
    odom, variances = record.odom[400]
    record.odom[400] = odom._replace(pose=odom.pose._replace(x=odom.pose.x + 50.0)), variances     # an outlier
    estimates = bases.run_filter(record)
    assert len(estimates) == len(record.truth)
    assert [estimates[number].stamp for number in (399, 400, 401)] == [
        record.odom[number][0].stamp for number in (399, 399, 401)]


def test_errors_are_root_mean_squares_over_the_seeds():
    row = bases.figures('a', 2, numpy.array([8.0, 2.0, 18.0, 0.5, 50.0, 0.02, 32.0, 8.0, 72.0, 0.0, 5.0, 18.0]))
    assert row.pop('case') == 'a'
    assert row == pytest.approx(dict(heading=2.0, position=1.0, port_heading=3.0, port_position=0.5,
                                     reckoned_heading=5.0, reckoned_position=0.1, wheels_heading=4.0,
                                     wheels_position=2.0, textbook_heading=6.0, textbook_position=0.0, nees=2.5,
                                     claimed=3.0))


@pytest.mark.parametrize('values, missed', [
    ({'heading': 1.69}, []),
    ({'heading': 1.71}, ['heading']),       # 1.2 times the error of dead reckoning, plus 0.5
    ({'heading': 1.11, 'port_heading': 0.5}, ['heading']),
    ({'position': 0.141}, ['position']),    # 1.2 times, plus 0.02
    # without a rest: 1.5 times the textbook filter, plus 3
    ({'case': 'lab_circle_no_rest', 'heading': 5.99, 'port_heading': 0.5, 'textbook_heading': 2.0}, []),
    ({'case': 'lab_circle_no_rest', 'heading': 6.01, 'textbook_heading': 2.0}, ['heading']),
    ({'case': 'frozen', 'heading': 2.76, 'wheels_heading': 0.5}, ['heading']),      # 1.5 times the best of all, plus 2
    ({'nees': 0.099}, ['nees']),
    ({'nees': math.inf}, ['nees'])])
def test_limits(values, missed):
    assert bases.judged({**GOOD, **values})['misses'] == missed


@pytest.mark.parametrize('unbiased, missed', [(0.84, []), (0.83, ['by_bias'])])
def test_the_heading_with_a_bias_is_compared_with_that_without(unbiased, missed):
    row = bases.judged(GOOD, dict(GOOD, heading=unbiased))
    assert row['by_bias'] == pytest.approx(1 / unbiased) and row['misses'] == missed
