"""Parameters of the base node and of the emulated robot: defaults, one line for each invalid value, and the files."""
import glob
import os

import pytest
import yaml

from rbx1_nav.extras.create.create_parameters import read_settings
from rbx1_nav.extras.create.emulator.fault_services import PARAMETERS
from rbx1_nav.node.config import ConfigError, Section
from rbx1_nav.node.parameters import read

FOLDER = os.path.join(os.path.dirname(__file__), '..', '..', '..', '..', 'config', 'create')
CALIBRATIONS = sorted(glob.glob(os.path.join(FOLDER, 'calibration', '*.yaml')))


def test_a_create_2_has_no_gyro():
    settings, robot = read_settings({'robot_type': 'create2'})
    assert not settings.has_gyro and robot.base_width == 0.235


@pytest.mark.parametrize('params, text', [
    ({'robot_type': 'roomba'}, "robot_type: 'roomba': expected one of auto, create, create2, roomba600_wifi"),
    ({'port': 3}, 'port: 3: expected the absolute path of a device, or auto'),
    ({'port': 'COM1'}, "port: 'COM1': expected the absolute path of a device, or auto"),
    ({'operation_mode': 0}, 'operation_mode: 0: expected one of 1, 2, 3'),
    ({'drive_mode': 'turtle'}, "drive_mode: 'turtle': expected one of twist"),
    ({'cmd_vel_timeout': 0}, 'cmd_vel_timeout: 0: expected a time from 0.05 to 10 in s'),
    ({'update_rate': float('nan')}, 'update_rate: nan: expected a rate from 5 to 60 in Hz'),
    ({'min_abs_yaw_vel': 2.0, 'max_abs_yaw_vel': 1.0}, 'min_abs_yaw_vel: 2.0: expected at most max_abs_yaw_vel, 1.0'),
    ({'odom_frame': 'x', 'base_frame': 'x'}, "base_frame: 'x': expected a frame other than odom_frame"),
    ({'left_wheel': 'x', 'right_wheel': 'x'}, "right_wheel: 'x': expected a joint other than left_wheel"),
])
def test_what_makes_no_sense(params, text):
    with pytest.raises(ConfigError) as caught:
        read_settings(params)
    assert str(caught.value) == text


@pytest.mark.parametrize('name, value, expected', [
    ('robot_type', ['create'], 'one of create, create2'), ('baud', 19201, 'one of 300, 600, 1200, '),
    ('baud', True, 'one of 300, '), ('mode_plus_one', 'yes', 'true or false'), ('drops_fractions', 1, 'true or false'),
    ('gyro_stuck', 1024, 'a count from -1 to 1023'), ('link', 7, 'a path'), ('seed', -1, 'random, or an integer'),
    ('charge', 3, 'a number from 0 to 2'), ('corruption', 'some', 'a number from 0 to 1'),
    ('wheel_base', 0, 'a factor from 0.1 to 10'), ('gyro_measurement_range', 0, 'a number from 1')])
def test_what_makes_no_sense_for_the_emulated_robot(name, value, expected):
    parameter, = (each for each in PARAMETERS if each.name == name)
    with pytest.raises(ConfigError) as caught:
        read([parameter], Section({name: value}))
    assert str(caught.value).startswith(f'{name}: {value!r}: expected {expected}')


def load(*path):
    """Return the content of a file."""
    with open(os.path.join(FOLDER, *path), encoding='utf-8') as file:
        return yaml.safe_load(file)


def test_the_files_have_the_defaults_of_the_node():
    assert read_settings({**load('parameters.yaml'), **load('calibration', 'default.yaml')}) == read_settings({})


@pytest.mark.parametrize('path', CALIBRATIONS, ids=os.path.basename)
@pytest.mark.parametrize('robot_type', ['create', 'create2'])
def test_a_calibration_is_accepted_and_complete(path, robot_type):
    calibration = load('calibration', os.path.basename(path))
    params = {**load('parameters.yaml'), **calibration, 'robot_type': robot_type}
    assert not read_settings(params)[1].unknown
    assert calibration.keys() == load('calibration', 'default.yaml').keys()
