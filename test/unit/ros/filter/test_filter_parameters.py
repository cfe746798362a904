"""The filter node checks the units and ranges of its limits."""
import pytest

from rbx1_nav.config import ConfigError
from rbx1_nav.ros.filter.ekf_parameters import read_parameters


@pytest.mark.parametrize('name, value, expected', [
    ('max_speed', 0, 'max_speed: 0: expected a speed from 0.01 to 1000 in m/s'),
    ('max_speed', float('nan'), 'max_speed: nan: expected a speed'),
    ('max_speed', '5', r"max_speed: '5' \(text to YAML: write 5 without quotes\): expected a speed"),
    ('max_turn_rate', -1, 'max_turn_rate: -1: expected a turn rate from 0.01 to 1000 in rad/s'),
    ('max_angular_acceleration', 1e5,
     r'max_angular_acceleration: 100000.0: expected an angular acceleration from 0.01 to 10000 in rad/s\^2'),
    ('gyro_bias', 0, 'gyro_bias: 0: expected a bias from 0.01 to 1000 in degrees/s'),
    ('gyro_bias', True, 'gyro_bias: True: expected a bias'),
    ('gyro_scale_error', 2, 'gyro_scale_error: 2: expected a fraction from 0 to 0.5'),
    ('gyro_scale_error', {}, 'gyro_scale_error: {}: expected a fraction')])
def test_a_bad_value_is_one_line(name, value, expected):
    with pytest.raises(ConfigError, match=f'^{expected}'):
        read_parameters({name: value})
