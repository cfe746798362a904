"""The calibration scripts print the factors that follow from what was reported and measured."""
import pytest

from rbx1_nav.extras.create.angle_fractions import MEASURED, TEST
from loaded_nodes import load, without_master

RUN = {'odom_angular_scale_correction': 1.25, 'gyro_scale_correction': 0.8, 'reported': 400.0, 'gyro': 320.0}


@pytest.fixture(name='calibrate')
def fixture_calibrate(monkeypatch, capsys):
    """Runs calibrate_angular.py after a turn; returns (what it prints, its warnings)."""
    module = load('calibrate_angular')
    _, log = without_master(monkeypatch)
    monkeypatch.setattr(module, 'start_node', lambda *_: None)

    def calibrate(answer, run=RUN, fractions=''):
        monkeypatch.setattr(module, 'measure', lambda: (dict(run), fractions))
        monkeypatch.setattr(module, 'ask', lambda _, read: answer and read(answer))
        module.calibrate()
        return capsys.readouterr().out, [line for level, line in log if level == 'warn']
    return calibrate


def test_both_factors_follow_from_the_same_turn(calibrate):
    out, warnings = calibrate('360')
    assert 'The odometry reports 400.0 degrees.\nThe gyro reports 320.0 degrees.\n' in out
    assert 'The factors were 1.2500, 0.8000. Now they should be:\n' in out and not warnings
    assert out.endswith('odom_angular_scale_correction: 1.1250\ngyro_scale_correction: 0.9000\n')


def test_without_a_gyro_one_factor_is_printed(calibrate):
    out, _ = calibrate('360', {key: value for key, value in RUN.items() if key != 'gyro'})
    assert 'The factor was 1.2500. Now it should be:\nodom_angular_scale_correction: 1.1250\n' in out
    assert 'gyro' not in out


def test_an_implausible_factor_of_the_gyro_is_not_printed(calibrate):
    out, warnings = calibrate('360', dict(RUN, gyro=3.0))
    assert out.endswith('odom_angular_scale_correction: 1.1250\n')
    assert len(warnings) == 1 and 'The gyro is not calibrated: gyro_scale_correction' in warnings[0]


@pytest.mark.parametrize('run, lines', [(RUN, 2), ({**RUN, 'gyro': None}, 1)])
def test_without_an_answer_the_formulas_are_printed(calibrate, run, lines):
    out, _ = calibrate(None, {key: value for key, value in run.items() if value})
    formulas = [line for line in out.splitlines() if 'DEGREES' in line]
    assert len(formulas) == lines
    assert formulas[0].startswith('odom_angular_scale_correction: 1.2500 * DEGREES / 400.0')


def test_a_robot_that_loses_fractions_is_reported(calibrate):
    assert 'angle_fractions: dropped\nSet angle_fractions first' in calibrate('360', fractions=f'{MEASURED}dropped')[0]
    assert 'not known yet: expected a slower turn' in calibrate('360', fractions=TEST)[0]
    assert 'fractions' not in calibrate('360')[0]
