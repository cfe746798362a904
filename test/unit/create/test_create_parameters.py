"""Parameters of the base node: create_node's names and defaults, and a one-line message for each invalid value."""
import pytest

from rbx1_nav.config import ConfigError
from rbx1_nav.create.driver.settings import read_settings


def test_a_create_2_has_no_gyro():
    settings, robot = read_settings({'robot_type': 'create2'})
    assert not settings.has_gyro and robot.base_width == 0.235


@pytest.mark.parametrize('params, text', [
    ({'robot_type': 'roomba'}, "robot_type: 'roomba': expected one of auto, create, create2"),
    ({'robot_type': ['create']}, "robot_type: ['create']: expected one of auto, create, create2"),
    ({'port': 3}, 'port: 3: expected the absolute path of a device, or auto'),
    ({'port': 'COM1'}, "port: 'COM1': expected the absolute path of a device, or auto"),
    ({'operation_mode': 0}, 'operation_mode: 0: expected one of 1, 2, 3'),
    ({'operation_mode': True}, 'operation_mode: True: expected one of 1, 2, 3'),
    ({'drive_mode': 'turtle'}, "drive_mode: 'turtle': expected one of twist"),
    ({'robot_type': 'create2', 'has_gyro': True},
     'has_gyro: True: expected false, because a create2 has no analog input for a gyro'),
    ({'cmd_vel_timeout': 0}, 'cmd_vel_timeout: 0: expected a time from 0.05 to 10 in s'),
    ({'update_rate': float('nan')}, 'update_rate: nan: expected a rate from 5 to 60 in Hz'),
    ({'min_abs_yaw_vel': 2.0, 'max_abs_yaw_vel': 1.0}, 'min_abs_yaw_vel: 2.0: expected at most max_abs_yaw_vel, 1.0'),
    ({'odom_frame': 'x', 'base_frame': 'x'}, "base_frame: 'x': expected a frame other than odom_frame"),
    ({'left_wheel': ''},
     "left_wheel: '': expected the name of a joint: a letter, then up to 199 letters, digits or _ - . /"),
    ({'left_wheel': 'x', 'right_wheel': 'x'}, "right_wheel: 'x': expected a joint other than left_wheel"),
])
def test_what_makes_no_sense(params, text):
    with pytest.raises(ConfigError) as caught:
        read_settings(params)
    assert str(caught.value) == text
