"""The turns of wheels and gyro in a window decide which sensor is doubted, and what is learned; doubts are reported."""
from math import degrees, radians

import numpy
import pytest

from rbx1_nav.base.kinematics import ORIGIN
from rbx1_nav.base.units import SECOND
from rbx1_nav.filter.filter import (
    BIAS, CURVATURE, FIRST_BIAS, SCALE, SLIP_STRAIGHT, SLIP_TURNING, WINDOW, Y, YAW, Filter)
from rbx1_nav.filter.gyro_readings import Sums
from rbx1_nav.filter.priors import UNKNOWN_FLOOR
from rbx1_nav.filter.sensors import CONTRADICTION, Doubts


def judge(ekf, window, *sums):
    """Return the doubt of a window of 10 s. window: P of the difference; sums: the turns of the wheels, expected and of
    the gyro (rad), forward (m), and the variance of the wheels."""
    ekf.P[WINDOW, WINDOW] = window
    ekf.window.add(Sums(10.0, *sums))
    (found, doubt), zero = ekf.close_window(), numpy.zeros(9)
    assert found[:6] == (10.0, *sums)
    assert (ekf.P[WINDOW] == zero).all() and (ekf.P[:, WINDOW] == zero).all() and ekf.window.sums == Sums()
    return doubt


@pytest.mark.parametrize('sign', [1, -1])
@pytest.mark.parametrize('sigma, window, wheels, gyro, verdict, after', [
    # 1 and 0.6 rad are more than 5 sigma of the difference; a turn of less than 1 rad does not measure the slip
    (0.2, 0.01, 2.0, 1.0, 'wheels', 0.5), (0.6, 0.01, 2.0, 1.0, 'wheels', 0.6), (0.1, 0.01, 0.9, 0.3, 'wheels', 0.2),
    (0.3, 0.03, 2.0, 1.8, '', 0.85 * 0.3), (0.3, 0.03, 2.0, 1.44, '', 0.28), (0.055, 0.03, 2.0, 1.99, '', 0.05),
    (0.3, 0.03, 0.9, 0.8, '', 0.3), (0.1, 0.03, 2.0, 1.5, '', 0.1),
    # with any slip, wheels that report 2 rad turn by 0.6 to 2.6 rad; 3 sigma without slip are 0.45 rad
    (0.4, 0.8 ** 2 + 0.02, 2.0, 0.1, 'both', 0.4), (0.4, 0.8 ** 2 + 0.02, 2.0, 3.1, 'both', 0.4),
    (0.4, 0.8 ** 2 + 0.02, 2.0, 0.2, '', 0.4), (0.4, 0.8 ** 2 + 0.02, 2.0, 3.0, '', 0.4)])
def test_a_difference_in_a_turn_is_slip_or_a_doubt_of_the_heading(sign, sigma, window, wheels, gyro, verdict, after):
    ekf = Filter(UNKNOWN_FLOOR._replace(slip_turning_spread=0.2, slip_straight_spread=0.02), ORIGIN)
    ekf.P[SLIP_TURNING, SLIP_TURNING], ekf.doubt = sigma ** 2, [0.1, 0.2, 0.3]
    assert judge(ekf, window, sign * wheels, sign * wheels, sign * gyro, 0.0, 0.002) == verdict
    assert ekf.sigma(SLIP_TURNING) == pytest.approx(after)
    assert ekf.sigma(SLIP_STRAIGHT) == pytest.approx(0.05 if verdict == 'wheels' else 0.02)
    # one of the wheels has slipped, half of the track from the middle
    moved = (0.2 * (wheels - gyro)) ** 2 if verdict == 'wheels' else 0.0
    assert ekf.P.diagonal()[:3].tolist() == pytest.approx([moved, moved, 0.0], abs=2e-9)    # first pose: 1e-9
    assert ekf.doubt == pytest.approx([0.085, 0.17, 0.255] if verdict == '' else [
        0.1, 0.2, 0.3 + (abs(wheels - gyro) if verdict == 'both' else 0.0)])
    assert ekf.state == [0.0] * 5


def correlate(ekf, *pairs):
    """Set covariances of a Filter: (index, index, value)."""
    for one, other, value in pairs:
        ekf.P[one, other] = ekf.P[other, one] = value


@pytest.mark.parametrize('rested, forward, drifting, learned', [
    (True, 5.0, False, True), (True, -5.0, True, True), (True, 2.9, True, False), (False, 5.0, True, False)])
def test_straight_motion_after_a_rest_shows_the_curvature_and_the_bias_if_it_drifts(rested, forward, drifting, learned):
    ekf = Filter(UNKNOWN_FLOOR, ORIGIN)
    ekf.rested, ekf.walk = rested, 1e-6 if drifting else ekf.walk
    correlate(ekf, (WINDOW, CURVATURE, 0.01), (WINDOW, BIAS, 0.02), (WINDOW, YAW, 0.05), (YAW, YAW, 0.5),
              (YAW, CURVATURE, 0.003), (YAW, SLIP_TURNING, 0.02), (YAW, SCALE, 0.01))
    bias = ekf.P[BIAS, BIAS]
    # a difference of 0.2 rad, in one block: its scatter is less than the variance of the wheels
    assert judge(ekf, 0.04, 0.1, 0.3, 0.5, forward, 0.03) == ''
    S = 0.04 + 0.2 ** 2 / 2
    # the heading, without what slip, scale and curvature have to do with it
    gain = (0.05 + 0.1 * 0.02 - 0.5 * 0.01 - forward * 0.003) / S if learned and drifting else 0.0
    assert ekf.state == pytest.approx([0.0, 0.0, gain * 0.2, 0.02 / S * 0.2 if learned and drifting else 0.0,
                                       0.01 / S * 0.2 if learned else 0.0])
    assert ekf.P.diagonal()[[YAW, BIAS, CURVATURE]].tolist() == pytest.approx([
        0.5 - 2 * gain * 0.05 + gain ** 2 * S, bias - (0.02 ** 2 / S if learned and drifting else 0.0),
        0.05 ** 2 - (0.01 ** 2 / S if learned else 0.0)])


@pytest.mark.parametrize('gyro, since, doubt', [(0.1, 200.0, 'imu_data'), (-0.1, 200.0, 'imu_data'),
                                                (0.1, 20.0, 'both'), (0.2, 200.0, 'both')])
def test_a_difference_in_straight_motion_is_a_drift_since_the_rest(gyro, since, doubt):
    """since: the turn (rad) that a drift of 1 rad/s^2 would have caused in the window."""
    ekf = Filter(UNKNOWN_FLOOR, ORIGIN)
    ekf.rested, ekf.moving = True, 40.0
    ekf.drift[[YAW, BIAS, WINDOW]] = 800.0, 40.0, since
    correlate(ekf, (WINDOW, CURVATURE, 0.001))
    assert judge(ekf, 1e-4, 0.0, 0.0, gyro, 5.0, 1e-4) == doubt
    if doubt == 'both':     # a drift that is improbable, or that the window hardly shows
        assert ekf.doubt[YAW] == abs(gyro) and not any(ekf.state)
        return
    rate = gyro / 200
    S = 1e-4 + gyro ** 2 + 1e-4
    curvature = 0.001 / S * gyro
    assert ekf.state == pytest.approx([0, 0, rate ** 2 * 200 * 800 / S * gyro, rate ** 2 * 200 * 40 / S * gyro,
                                       curvature])
    assert ekf.walk == pytest.approx(rate ** 2 * 40)
    # half of the curvature may be a drift that turns as much at this speed, 0.5 m/s
    assert ekf.P[CURVATURE, [CURVATURE, BIAS]].tolist() == pytest.approx([
        0.05 ** 2 - 0.001 ** 2 / S + curvature ** 2 / 4,
        -0.001 * rate ** 2 * 200 * 40 / S - curvature ** 2 / 4 * 0.5])


def test_a_drift_while_the_robot_drives_straight_is_found_and_corrected():
    ekf, doubts = Filter(UNKNOWN_FLOOR, ORIGIN), []
    ekf.learn_bias(0.0, 1e-10)
    for number in range(3000):      # 0.34 degrees/s in a minute, at 0.2 m/s
        ekf.step(0.02, ekf.turn(0.02, (0.0, 0.0), (1e-4 * number * 0.02 ** 2, 1e-10), 0.004), 0.0, 0.004)
        verdict = ekf.close_window()
        doubts += [verdict[1]] if verdict else []
    assert 'imu_data' in doubts and doubts[-1] == ''
    assert ekf.bias == pytest.approx(0.006, abs=0.001) and abs(ekf.state[YAW]) < 0.01   # uncorrected: 0.18
    assert abs(ekf.state[Y]) < 0.05


def report(verdicts, rested=True, doubt=0.0):
    """Return the warnings for doubts, one per second. doubt: of the heading, rad."""
    warnings, doubts, ekf = [], Doubts(warn=lambda text: warnings.append(text)), Filter(UNKNOWN_FLOOR, ORIGIN)
    ekf.rested, ekf.doubt[YAW] = rested, doubt
    for second, doubted in enumerate(verdicts):
        doubts.report((Sums(time=20.0, wheels=2.0, gyro=1.0), doubted), ekf, second * SECOND)
    return warnings, doubts


def test_a_doubt_and_its_end_are_reported_once():
    warnings, doubts = report(['', 'wheels', 'wheels', '', '', '', '', '', ''])
    assert warnings == ['odom turned by 2.00 rad, imu_data by 1.00 rad in 20.0 s: the wheels slip; the heading follows '
                        'the gyro', 'odom and imu_data agree again']
    assert doubts.doubted == 'nothing' and not doubts.contradicts(8 * SECOND)
    warnings, doubts = report(['', 'both'])
    assert warnings[0].endswith(': one of them is wrong; the heading is uncertain')
    assert doubts.doubted == 'both since 1.0 s' and doubts.contradicts(SECOND + CONTRADICTION - 1)
    assert not doubts.contradicts(SECOND + CONTRADICTION)
    assert len(report(['both', ''], doubt=0.2)[0]) == 1     # the heading is still in doubt


def test_a_robot_that_was_never_at_rest_is_reported_once():
    warnings, _ = report(['', '', ''], rested=False)
    assert warnings == ['the robot has not been at rest yet, so the bias of the gyro is unknown: the heading may drift '
                        f'by {degrees(FIRST_BIAS * radians(10)):.1f} degrees/s or more']
