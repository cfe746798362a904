"""The exercise without ROS: the distances by which each method misses, over twenty seeds."""
import os
import re
from math import cos, degrees, hypot, pi, remainder, sin
from statistics import median

import numpy
import pytest

from rbx1_nav.base.robot_parameters import load_robot
from rbx1_nav.base.surfaces import load_surface
from rbx1_nav.exercise.methods import METHODS
from rbx1_nav.extras.many_runs.simulated_run import PARAMETERS, simulate
from rbx1_nav.filter.priors import priors

ROOT = os.path.join(os.path.dirname(__file__), '..', '..', '..', '..')
CONFIG = os.path.join(ROOT, 'config')
SEEDS = range(20)
CARPET, FLOOR = (load_surface(name, os.path.join(CONFIG, 'surfaces')) for name in ('low_ply_carpet', 'hard_floor'))
TURTLEBOT = load_robot(os.path.join(CONFIG, 'turtlebot.yaml'))


def angle(pose):
    """Return the angle between the heading at the start and the heading of a pose, degrees."""
    return abs(degrees(remainder(pose.yaw, 2 * pi)))


def distance(pose, other=(0.0, 0.0)):
    """Return the distance of a pose from the start, or from another pose, m."""
    return hypot(pose[0] - other[0], pose[1] - other[1])


def misses(method, surface, seeds):
    """Return the distance from the start (m) and the angle (degrees) at the end of each run."""
    ends = [simulate(method, TURTLEBOT, surface, seed).end.truth for seed in seeds]
    return numpy.array([(distance(end), angle(end)) for end in ends])


def test_by_time_it_misses_as_in_the_picture_of_the_tutorial():
    runs = [simulate('timed', TURTLEBOT, CARPET, seed) for seed in SEEDS]
    for run in runs:
        truth = run.end.truth
        # five standard deviations of the noise: 0.044 m and 12 degrees
        assert 0.70 < run.first_leg < 1.14
        assert 0 < truth.y < 1 and truth.yaw < 2 * pi
    assert median(run.end.truth.y for run in runs) == pytest.approx(0.47, abs=0.1)
    assert median(angle(run.end.truth) for run in runs) == pytest.approx(63, abs=10)
    # the odometry measures most of the error
    assert median(distance(run.end.truth, run.end.odometry) for run in runs) < 0.20
    assert median(degrees(abs(run.end.truth.yaw - run.end.odometry.yaw)) for run in runs) > 3


def test_odometry_brings_it_nearer_to_the_start_and_the_gyro_still_nearer():
    # means of 100 runs: 48, 15, 8 cm and 62, 14, 5 degrees
    timed, by_odometry, with_gyro = (numpy.mean(misses(method, CARPET, SEEDS), axis=0)
                                     for method in ('timed', 'odom', 'ekf'))
    assert (by_odometry < timed / 2).all() and (with_gyro < by_odometry / 1.3).all()
    assert with_gyro == pytest.approx([0.07, 4.4], rel=0.5)


def test_on_a_hard_floor_the_gyro_makes_it_no_worse():
    # 40 seeds, to save time; the means of 100 are 1.4 and 0.8 cm, 1.8 and 0.9 degrees
    by_odometry, with_gyro = (misses(method, FLOOR, range(40)) for method in ('odom', 'ekf'))
    for average in numpy.mean, numpy.median:
        assert (average(with_gyro, axis=0) <= average(by_odometry, axis=0)).all()


@pytest.mark.parametrize('method', ['odom', 'ekf'])
def test_on_the_ideal_surface_it_ends_at_the_start_by_pose(method):
    run = simulate(method, TURTLEBOT, None, 0)
    assert distance(run.end.truth) < 0.005 and angle(run.end.truth) < 0.5


def test_on_the_ideal_surface_it_ends_at_the_exact_pose_by_time():
    run = simulate('timed', TURTLEBOT, None, 0)
    assert run.end.truth == run.end.odometry == pytest.approx((1 + cos(3.14), sin(3.14), 6.28), abs=1e-12)


def test_the_estimate_has_a_smaller_error_than_the_odometry_and_an_honest_covariance():
    squares, ends = numpy.zeros(4), []
    for seed in range(40):
        run = simulate('timed', TURTLEBOT, CARPET, seed, filtered=True, keep=True)
        for _, truth, odometry, estimate in run.path[::5]:
            squares += [remainder(odometry.yaw - truth.yaw, 2 * pi) ** 2,
                        remainder(estimate.yaw - truth.yaw, 2 * pi) ** 2,
                        distance(odometry, truth) ** 2, distance(estimate, truth) ** 2]
        error = numpy.subtract(run.end.estimate, run.end.truth)
        error[2] = remainder(error[2], 2 * pi)
        ends.append(error @ numpy.linalg.solve(run.covariance, error))
    heading_odom, heading, position_odom, position = squares ** 0.5
    assert heading < heading_odom / 3 and position < position_odom
    # chi-square with 3 degrees of freedom; 1 sigma of the mean of 40 is 0.39. bench/filter.py tests 200 seeds
    assert 1.5 < numpy.mean(ends) < 5


@pytest.mark.parametrize('method', METHODS)
def test_a_run_depends_on_the_seed_only(method):
    one, again, other = (simulate(method, TURTLEBOT, CARPET, seed).end for seed in (5, 5, 6))
    assert one == again and one.truth != other.truth


def test_another_floor_may_be_assumed_than_the_true_one():
    own, same, other = (simulate('timed', TURTLEBOT, CARPET, 5, filtered=True, prior=prior).end
                        for prior in (None, priors(CARPET), priors(FLOOR)))
    assert own == same and own._replace(estimate=None) == other._replace(estimate=None)
    assert own.estimate != other.estimate


@pytest.mark.parametrize('method', METHODS.values(), ids=lambda each: each.name)
def test_the_simulation_drives_with_the_defaults_of_the_script(method):
    with open(os.path.join(ROOT, 'nodes', method.script), encoding='utf-8') as file:
        found = re.findall(r'(?m)^    ~(\w+) .* default: ([\d.]+|pi)\)$', file.read())
    defaults = {name: pi if value == 'pi' else float(value) for name, value in found if name in PARAMETERS}
    assert len(defaults) >= 5 and defaults == {name: PARAMETERS[name] for name in defaults}
