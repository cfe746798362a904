"""The uncertainty that the odometry reports, against arithmetic by hand, and what resets it."""
from math import pi

import pytest

from rbx1_nav.base.covariances import MEASURED
from rbx1_nav.base.kinematics import ORIGIN
from rbx1_nav.simulation.floor import Floor
from rbx1_nav.simulation.slip import RandomErrors
from rbx1_nav.simulation.wheels import IdealWheels, Wheels
from sample_surface import RUN, SURFACE

WIDTH, WINDOW = 0.25, 0.02
TICK = 1 / 4100
NO_SLIP = RandomErrors(0.0, 0.0, 0.0, 0.0)
FLAT = SURFACE._replace(slip_straight=0.0, slip_straight_spread=0.0, slip_turning=0.0, slip_turning_spread=0.0)


def drive(wheels, *commands):
    """Drive 200 steps with each command (linear, angular); return the path (m) and the angle (rad) that were counted.

    Both directions count positive.
    """
    path = turned = 0.0
    for command in commands:
        for _ in range(200):
            left, right = wheels.travel(*command, WINDOW)
            path += abs(left + right) / 2
            turned += abs(right - left) / WIDTH
    return path, turned


@pytest.mark.parametrize('commands', [[(0.0, 0.0)], [(0.2, 0.0)], [(0.0, -1.0)], [(0.2, 0.5)],
                                      [(0.2, 0.0), (-0.3, 0.0)], [(0.1, 1.0), (-0.1, -1.0), (0.3, 0.0)]])
def test_the_variances_of_the_pose_are_those_of_the_slip_and_of_a_tick(commands):
    wheels = Wheels(WIDTH, Floor(SURFACE, RUN), WINDOW)
    path, turned = drive(wheels, *commands)
    # slip of 2 % with a spread of 1 %, and of 3 % with a spread of 1 % in turns; the heading shifts the whole path
    straight, yaw = 0.02 ** 2 + 0.01 ** 2, (0.03 ** 2 + 0.01 ** 2) * turned ** 2
    assert wheels.uncertainty.position == pytest.approx((straight + yaw) * path ** 2 + TICK ** 2)
    assert wheels.uncertainty.yaw == pytest.approx(yaw + (TICK / WIDTH) ** 2)


def test_the_variances_of_the_pose_are_those_of_the_noise():
    noisy = FLAT._replace(distance_noise=0.03, heading_noise_turning=0.1, heading_noise_straight=0.2)
    wheels = Wheels(WIDTH, Floor(noisy, NO_SLIP), WINDOW)
    path, turned = drive(wheels, (0.2, 0.5), (-0.1, 0.7))
    yaw = 0.1 ** 2 * turned + 0.2 ** 2 * path
    assert wheels.uncertainty.position == pytest.approx(TICK ** 2 + 0.03 ** 2 * path + yaw * path ** 2)
    assert wheels.uncertainty.yaw == pytest.approx((TICK / WIDTH) ** 2 + yaw)


@pytest.mark.parametrize('window', [0.02, 0.1])
def test_the_variances_of_the_speeds_are_those_of_whole_ticks(window):
    wheels = Wheels(WIDTH, Floor(FLAT, NO_SLIP), window)
    drive(wheels, (0.2, 0.5))
    # the count of a wheel has two rounding errors of 1/12 tick^2; the mean of two wheels has half of this variance, and
    # their difference twice this variance
    wheel = 2 / 12 * TICK ** 2 / window ** 2
    assert wheels.uncertainty.linear == pytest.approx(1e-6 + wheel / 2)
    assert wheels.uncertainty.angular == pytest.approx(1e-6 + wheel * 2 / WIDTH ** 2)


@pytest.mark.parametrize('command', [(-0.2, -0.5), (0.2, 0.0), (0.0, 0.5)])
def test_the_variances_of_the_speeds_grow_with_the_noise_in_both_directions(command):
    rough = FLAT._replace(distance_noise=0.03, heading_noise_turning=0.1, heading_noise_straight=0.2)
    more, less = (Wheels(WIDTH, Floor(surface, NO_SLIP), WINDOW) for surface in (rough, FLAT))
    for wheels in more, less:
        drive(wheels, command)
    linear, angular = map(abs, more.velocity())
    assert more.uncertainty.linear - less.uncertainty.linear == pytest.approx(0.03 ** 2 * linear / WINDOW)
    assert more.uncertainty.angular - less.uncertainty.angular == pytest.approx(
        (0.1 ** 2 * angular + 0.2 ** 2 * linear) / WINDOW)


@pytest.mark.parametrize('step, steps', [(0.02, 1), (0.016, 1), (0.014, 2), (0.008, 2), (0.007, 3)])
def test_a_speed_is_reported_after_about_a_window(step, steps):
    """Steps differ slightly from their nominal length, so three quarters of a window are enough."""
    wheels, reported = Wheels(WIDTH, Floor(SURFACE._replace(ticks_meter=1e6), RUN), WINDOW), []
    while not any(wheels.velocity()):
        wheels.travel(0.5, 1.0, step)
        reported.append(wheels.velocity())
    assert len(reported) == steps
    linear, angular = wheels.velocity()
    # the mean speed over these steps: counts of 1 um
    assert linear * step * steps == pytest.approx((wheels.left.total + wheels.right.total) / 2, abs=1e-6)
    assert angular * step * steps == pytest.approx((wheels.right.total - wheels.left.total) / WIDTH, abs=2e-6 / WIDTH)


def test_after_a_reset_wheels_are_like_new_ones():
    surface = SURFACE._replace(delay=0.05)
    used, new = (Wheels(WIDTH, Floor(surface, RUN), WINDOW) for _ in range(2))
    for _ in range(51):     # an odd number of steps that are shorter than the window
        used.travel(0.4, 1.0, 0.014)
    used.reset()
    assert used.at_rest and used.velocity() == used.true_velocity() == (0.0, 0.0) and used.truth.pose == ORIGIN
    assert used.uncertainty == new.uncertainty == pytest.approx((TICK ** 2, (TICK / WIDTH) ** 2, 1e-6, 1e-6))
    for _ in range(30):
        for wheels in used, new:
            wheels.travel(0.3, -0.5, 0.014)
        assert used.truth.pose == new.truth.pose
        # a count may differ by a tick, because the encoders are not reset
        assert used.velocity() == pytest.approx(new.velocity(), abs=2.01 * TICK / WIDTH / 0.028)
        assert any(used.velocity()) is any(new.velocity())


def test_ideal_wheels_follow_each_command_exactly():
    wheels = IdealWheels(WIDTH)
    assert wheels.travel(0.2, 0.8, 0.5) == pytest.approx((0.05, 0.15))
    assert wheels.truth.pose.yaw == pytest.approx(0.4) and wheels.at_rest
    assert wheels.velocity(0.2, 0.8) == wheels.true_velocity(0.2, 0.8) == (0.2, 0.8)
    assert wheels.uncertainty == (MEASURED,) * 4 == (1e-6,) * 4
    wheels.reset()
    assert wheels.truth.pose == ORIGIN
    wheels.travel(0.0, 2 * pi, 0.5)
    assert wheels.truth.pose == pytest.approx((0.0, 0.0, pi))
