"""The parameters of the base node have the defaults and the ranges of the table in docs/bases.md."""
import os
import re

import pytest

from rbx1_nav.config import ConfigError
from rbx1_nav.create import protocol
from rbx1_nav.create.driver.parameters import read_settings

PAGE = os.path.join(os.path.dirname(__file__), '..', '..', '..', 'docs', 'bases.md')
# where read_settings() puts each number
NUMBERS = {
    'update_rate': lambda settings, robot: settings.update_rate,
    'cmd_vel_timeout': lambda settings, robot: robot.timeout / 1e9,
    'min_abs_yaw_vel': lambda settings, robot: settings.min_yaw_speed,
    'max_abs_yaw_vel': lambda settings, robot: robot.limits.angular,
    'gyro_measurement_range': lambda settings, robot: settings.gyro_range,
    'gyro_scale_correction': lambda settings, robot: settings.gyro_correction,
    'odom_linear_scale_correction': lambda settings, robot: settings.linear_correction,
    'odom_angular_scale_correction': lambda settings, robot: settings.angular_correction,
    'odom_linear_error': lambda settings, robot: settings.errors.linear,
    'odom_angular_error': lambda settings, robot: settings.errors.angular,
    'odom_heading_error': lambda settings, robot: settings.errors.heading,
    'moving_yaw_variance': lambda settings, robot: settings.moving_yaw_variance}


def documented():
    """Return {name: (default, low, high)} of the numbers in the table."""
    with open(PAGE, encoding='utf-8') as file:
        table = file.read().split('<!-- parameters: turtlebot_node.py -->')[1].split('**Commands**')[0]
    rows = re.findall(r'(?m)^\| `~(\w+)` \| ([\d.]+) \| [^|]* \| ([\d.]+) to ([\d.]+) \|', table)
    return {name: tuple(map(float, values)) for name, *values in rows}


def test_the_table_has_all_numbers():
    assert set(documented()) == set(NUMBERS)


@pytest.mark.parametrize('name', NUMBERS)
def test_a_number(name):
    default, low, high = documented()[name]
    value = NUMBERS[name]
    if name != 'max_abs_yaw_vel':       # 0 means no limit
        assert value(*read_settings({})) == pytest.approx(default)
        assert value(*read_settings({'max_abs_yaw_vel': 10, name: low})) == pytest.approx(low)
    assert value(*read_settings({'max_abs_yaw_vel': 10, name: high})) == pytest.approx(high)
    for wrong in low - 1e-6, high + 1e-6:
        with pytest.raises(ConfigError, match=f'^{name}: .*expected'):
            read_settings({name: wrong})


def test_there_is_no_limit_unless_one_is_given():
    limits = read_settings({})[1].limits
    assert limits.linear == limits.angular == float('inf')


def test_the_other_defaults():
    settings, robot = read_settings({})
    assert settings.baud is None and settings.mode_plus_one is None and settings.robot_type == 'auto'
    assert not settings.wake and settings.stop_on_bump and settings.angle_fractions == 'auto'
    assert robot.wheel_radius == pytest.approx(0.033) and robot.joints == robot.hardware == robot.unknown == []
    assert robot.name == 'auto'


@pytest.mark.parametrize('params, name, value', [
    ({'baud': 19200}, 'baud', 19200), ({'oi_mode_workaround': True}, 'mode_plus_one', True),
    ({'oi_mode_workaround': False}, 'mode_plus_one', False), ({'wake_robot': True}, 'wake', True),
    ({'stop_motors_on_bump': False}, 'stop_on_bump', False), ({'has_gyro': False}, 'has_gyro', False),
    ({'robot_type': 'create2'}, 'model', protocol.CREATE_2), ({'robot_type': 'create'}, 'model', protocol.CREATE),
    ({'operation_mode': 3.0}, 'mode', 3), ({'operation_mode': 1}, 'mode', 1), ({'port': '/dev/x'}, 'port', '/dev/x'),
    ({'angle_fractions': 'lost'}, 'angle_fractions', 'lost')])
def test_a_parameter_sets_its_setting(params, name, value):
    assert getattr(read_settings(params)[0], name) == value


def test_a_create_2_may_be_said_to_have_no_gyro():
    assert not read_settings({'robot_type': 'create2', 'has_gyro': False})[0].has_gyro


@pytest.mark.parametrize('mode', [4, 2.5, '2', None, False])
def test_no_other_mode(mode):
    with pytest.raises(ConfigError, match='^operation_mode: '):
        read_settings({'operation_mode': mode})


def test_equal_limits_of_the_turning_speed():
    assert read_settings({'min_abs_yaw_vel': 1.0, 'max_abs_yaw_vel': 1.0})[0].min_yaw_speed == 1.0
