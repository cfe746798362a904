"""The values of an ArbotiX file have defaults and limits, and are kept in the units of the package."""
from math import radians

import pytest

from rbx1_nav.config import ConfigError
from rbx1_nav.robot.description import load_robot, read_robot
from rbx1_nav.units import SECOND


def describe(controller=(), joint=None, **top):
    """Return the Robot with these keys of the controller and of the joint `pan`, if there is one."""
    joints = {} if joint is None else {'joints': {'pan': joint}}
    return read_robot(dict(top, controllers={'base': dict({'type': 'diff_controller', 'base_width': 0.26},
                                                          **dict(controller))}, **joints))


def test_keys_that_are_given_replace_the_defaults():
    robot = describe({'rate': 25, 'timeout': 0.25, 'max_linear_speed': 0.5, 'max_angular_speed': 2.0,
                      'wheel_radius': 0.05, 'left_wheel': 'a', 'right_wheel': 'b'},
                     {'min_angle': 10, 'max_angle': 20, 'max_speed': 5}, publish_tf=False)
    assert (robot.rate, robot.timeout, robot.wheel_radius) == (25, SECOND // 4, 0.05)
    assert (robot.limits.linear, robot.limits.angular) == (0.5, 2.0) and robot.publish_tf is False
    assert robot.wheel_joints == ('a', 'b')
    joint, = robot.joints
    assert (joint.lower, joint.upper, joint.max_speed) == (radians(10), radians(20), radians(5))
    assert joint.position == radians(10)


def test_keys_of_the_hardware_and_unknown_keys_are_sorted():
    robot = describe({'ticks_meter': 4100, 'Kp': 12, 'bell': 1}, {'neutral': 512, 'id': 1, 'colour': 'red'},
                     port='/dev/ttyUSB0', baud=115200)
    assert robot.hardware == ['baud', 'controllers/base/Kp', 'controllers/base/ticks_meter', 'joints/pan/id',
                              'joints/pan/neutral', 'port']
    assert robot.unknown == ['controllers/base/bell', 'joints/pan/colour']


def test_a_file_is_named_in_the_error(tmp_path):
    path = tmp_path / 'robot.yaml'
    path.write_text('controllers: {base: {type: diff_controller, base_width: 0.3}}\n')
    assert load_robot(str(path)).base_width == 0.3
    path.write_text('controllers: {base: {type: diff_controller, base_width: -1}}\n')
    with pytest.raises(ConfigError) as error:
        load_robot(str(path))
    assert str(error.value).startswith(f'{path}: controllers/base/base_width: -1: expected')
