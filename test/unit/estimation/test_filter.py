"""The arithmetic of the filter: derivatives, covariances and means are right."""
from math import cos, sin

import numpy
import pytest
from hypothesis import given
from hypothesis import strategies as st

from rbx1_nav.estimation.filter import BIAS, BIAS_WALK, ROUNDING, SCALE, STRAIGHT, TURNING, X, YAW, Filter
from rbx1_nav.model.kinematics import ORIGIN
from sample_priors import IDEAL, PRIORS

angles = st.floats(-3, 3)
small = st.floats(-0.1, 0.1)
variances = st.floats(1e-9, 1e-3)


def after_step(state, wheels, gyro, forward, left, variance):
    """A filter, one step of 0.02 s after it had this state."""
    ekf = Filter(PRIORS, ORIGIN)
    ekf.state = list(state)
    ekf.covariance = numpy.diag([1e-6] * 8)
    turn = ekf.turn(0.02, wheels, gyro)
    ekf.move(0.02, turn, 0.1, forward, left, variance)
    return ekf


@given(st.tuples(small, small, angles, small, small, small, small, small), small, variances, small, small,
       st.sampled_from(['wheels', 'gyro']))
def test_the_covariance_follows_from_the_derivatives_of_a_step(state, angle, variance, forward, left, sensor):
    sensors = [(angle, variance), None] if sensor == 'wheels' else [None, (angle, variance)]
    ekf = after_step(state, *sensors, forward, left, 0.0)
    derivatives = numpy.zeros((8, 8))
    h = 1e-6
    for i in range(8):
        up, down = (after_step([v + s * (j == i) for j, v in enumerate(state)], *sensors, forward, left, 0.0).state
                    for s in (h, -h))
        derivatives[:, i] = (numpy.array(up) - down) / (2 * h)
    expected = derivatives @ numpy.diag([1e-6] * 8) @ derivatives.T
    # and the noise of the turn, which moves x and y by half of what a change of heading would
    # (of the robot's own heading half way, whatever frame the displacement is in)
    grip = 1 - state[STRAIGHT]
    along = forward + (state[ROUNDING] if forward or left else 0.0)
    middle = state[YAW] + (ekf.state[YAW] - state[YAW]) / 2 + 0.1
    by_turn = numpy.zeros(8)
    by_turn[:3] = (-grip * (along * sin(middle) + left * cos(middle)) / 2,
                   grip * (along * cos(middle) - left * sin(middle)) / 2, 1.0)
    scale = 1 - state[TURNING] if sensor == 'wheels' else 1 / (1 + state[SCALE])
    expected += numpy.outer(by_turn, by_turn) * variance * scale ** 2
    expected[BIAS, BIAS] += BIAS_WALK ** 2 * 0.02
    # central differences have an error of 1e-10 where the derivatives are about 1
    numpy.testing.assert_allclose(ekf.covariance, expected, atol=1e-12, rtol=1e-4)


@given(st.lists(st.tuples(small, small, variances, variances), min_size=1, max_size=30))
def test_the_covariance_stays_symmetric_and_positive(steps):
    ekf = Filter(PRIORS, ORIGIN)
    for turned, forward, wheel_variance, gyro_variance in steps:
        turn = ekf.turn(0.02, (turned, wheel_variance), (turned, gyro_variance))
        ekf.move(0.02, turn, 0.0, forward, 0.0, wheel_variance)
        numpy.testing.assert_allclose(ekf.covariance, ekf.covariance.T, rtol=1e-9, atol=1e-18)
        assert numpy.linalg.eigvalsh(ekf.covariance).min() > -1e-15
        assert numpy.isfinite(ekf.state).all()


@given(angles, angles, variances, variances)
def test_the_turn_is_the_mean_of_wheels_and_gyro_by_their_variances(by_wheels, by_gyro, wheel_noise, gyro_noise):
    ekf = Filter(IDEAL, ORIGIN)
    angle, noise, *_ = ekf.turn(0.02, (by_wheels, wheel_noise), (by_gyro, gyro_noise))
    if (by_wheels - by_gyro) ** 2 > 25 * (wheel_noise + gyro_noise):
        assert (angle, noise) == (by_gyro, gyro_noise) and ekf.outliers == 1
    else:
        # the inverse of a variance is the information, and that of both adds up
        assert 1 / noise == pytest.approx(1 / wheel_noise + 1 / gyro_noise)
        assert angle == pytest.approx((by_wheels / wheel_noise + by_gyro / gyro_noise) * noise, abs=1e-12)


def test_the_rounding_of_encoder_counts_does_not_accumulate():
    ekf = Filter(IDEAL, ORIGIN)
    for _ in range(1000):
        ekf.move(0.02, ekf.turn(0.02, (0.0, 1e-12), None), 0.0, 0.004, 0.0, 1e-8)
    # the variance of one rounding, half of that of a step
    assert ekf.covariance[X, X] == pytest.approx(0.5e-8 + 1e-9, rel=1e-3)
    assert ekf.state[X] == pytest.approx(4.0)
