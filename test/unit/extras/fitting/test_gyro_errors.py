"""The errors of a gyro are fitted to recorded runs."""
from math import radians

import pytest

from rbx1_nav.base.kinematics import Pose
from rbx1_nav.extras.fitting.gyro_fit import fit_gyro, rests_at
from rbx1_nav.simulation.slip import draw_run
from sample_runs import DRIVE, EXERCISE, FLOOR, FORWARD, record, wrapped


def test_noise_bias_and_scale():
    runs = [record(DRIVE, seed) for seed in range(4)]
    drawn = [draw_run(FLOOR, seed) for seed in range(4)]
    found = fit_gyro(runs, delay=1.0)
    value, error = found['gyro_noise']
    assert abs(value - FLOOR.gyro_noise) < 4 * error and error < 0.1 * value
    # the true errors of these runs; 100 readings at rest or more determine the bias to a tenth of the noise
    for key, tolerance in ('gyro_bias', 5e-4), ('gyro_scale_error', 2e-3):
        rms = (sum(getattr(run, key) ** 2 for run in drawn) / 4) ** 0.5
        assert found[key][0] == pytest.approx(rms, abs=tolerance), key


def test_scale_by_the_end_alone():
    surface = FLOOR._replace(gyro_scale_error=0.1)
    runs = []
    for seed in range(3):
        run = record(EXERCISE, seed, surface)
        end = Pose(run.truth.x[-1], run.truth.y[-1], wrapped(run.truth.yaw[-1]))
        runs.append(run._replace(truth=None, end=end))
    rms = (sum(draw_run(surface, seed).gyro_scale_error ** 2 for seed in range(3)) / 3) ** 0.5
    # an error of 2 degrees in a full turn is 0.0056, and is subtracted
    assert fit_gyro(runs, 1.0, radians(2))['gyro_scale_error'][0] == pytest.approx(rms, abs=0.006)


def test_a_run_without_rest_tells_nothing():
    assert fit_gyro([record((FORWARD,))], delay=1.0) == {}


def test_one_run_tells_no_spread():
    found = fit_gyro([record(DRIVE)], delay=1.0)
    assert found['gyro_bias'][1] == found['gyro_scale_error'][1] == float('inf')
    assert found['gyro_noise'][1] < 0.1 * found['gyro_noise'][0]


def test_a_robot_that_may_still_roll_does_not_stand():
    run = record(EXERCISE)
    at_rest = rests_at(run, run.truth.time, delay=0.5)
    assert at_rest[run.truth.time < 2].all()                # before the first motion
    assert not at_rest[(run.truth.time > 2.01) & (run.truth.time < 7.99)].any()     # drives, and 2 s of delay and rest
