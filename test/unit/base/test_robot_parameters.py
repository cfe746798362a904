"""YAML files in the ArbotiX format are read unchanged, and rejected with one line if a value is invalid."""
import copy
import glob
import os
from math import inf, nan, radians

import pytest
import yaml

from rbx1_nav.base.robot_parameters import load_robot, read_robot
from rbx1_nav.base.units import SECOND
from rbx1_nav.extras.create.protocol import MAX_SPEED
from rbx1_nav.node.config import ConfigError

CONFIG = os.path.join(os.path.dirname(__file__), '..', '..', '..', 'config')


def describe(controller=(), joint=None, **top):
    """Return the Robot with these keys of the controller and of the joint `pan`, if there is one."""
    joints = {} if joint is None else {'joints': {'pan': joint}}
    return read_robot(dict(top, controllers={'base': dict({'type': 'diff_controller', 'base_width': 0.26},
                                                          **dict(controller))}, **joints))


def load(name):
    with open(os.path.join(CONFIG, name)) as file:
        return yaml.safe_load(file)


def test_turtlebot():
    robot = read_robot(load('turtlebot.yaml'))
    assert (robot.name, robot.odom_frame_id, robot.base_frame_id) == ('base_controller', 'odom', 'base_footprint')
    # the driver's rate is for its hardware; the controller's rate is the rate of the odometry
    assert (robot.base_width, robot.rate, robot.timeout) == (0.26, 50, SECOND)
    assert robot.publish_tf is True
    assert robot.joints == [] and robot.unknown == []
    assert {'port', 'rate', 'controllers/base_controller/Kp'} <= set(robot.hardware)


def test_pi_robot():
    robot = read_robot(load('pi_robot.yaml'))
    assert robot.base_frame_id == 'base_link' and robot.unknown == []
    assert [joint.name for joint in robot.joints] == [
        'arm_shoulder_pan_joint', 'arm_shoulder_lift_joint', 'arm_elbow_flex_joint', 'arm_wrist_flex_joint',
        'gripper_joint', 'head_pan_joint', 'head_tilt_joint']
    assert robot.joints[-1].upper == radians(60) and robot.joints[-1].max_speed == radians(90)


@pytest.mark.parametrize('name', ['turtlebot.yaml', 'pi_robot.yaml'])
def test_the_speeds_are_those_of_a_create(name):
    limits = read_robot(load(name)).limits
    assert limits == (MAX_SPEED / 1000, 3.8)
    # 0.05: the limit is rounded down
    assert limits.angular == pytest.approx(MAX_SPEED / 1000 / (0.26 / 2), abs=0.05)


def test_unknown_keys_are_reported():
    params = load('turtlebot.yaml')
    params['controllers']['base_controller']['time_out'] = 2
    assert read_robot(params).unknown == ['controllers/base_controller/time_out (did you mean timeout?)']


def test_other_controllers_and_servos_that_end_earlier_are_named():
    params = load('turtlebot.yaml')
    params['controllers'].update(head={'type': 'follow_controller', 'joints': ['pan', 'tilt']}, arm=7)
    params['joints'] = {
        'pan': {'id': 1}, 'tilt': {'neutral': 300}, 'lift': {'neutral': 300, 'invert': True, 'min_angle': -200},
        'turn': {'ticks': 4096, 'min_angle': -180, 'max_angle': 180}, 'grip': {'range': 180, 'max_angle': 90},
        'low': {'neutral': 205, 'min_angle': -60}}
    # 300 degrees in 1024 ticks: 300 of them are 87.9 degrees
    text = 'joints/%s/neutral (with arbotix_driver, the joint moves from %s degrees)'
    assert read_robot(params).unknown == [
        'controllers/arm (None)', 'controllers/head (follow_controller)', text % ('grip', '-90.0 to 90.0'),
        text % ('lift', '-212.1 to 87.9'), text % ('tilt', '-87.9 to 212.1')]


@pytest.mark.parametrize('key, value, expected', [
    ('base_width', 0, 'from 0.001 to 100 in m'), ('base_width', '0.26', 'width'), ('base_width', nan, 'a width from'),
    ('base_width', True, 'width'), ('rate', -5, 'from 0.1 to 1000 in Hz'), ('rate', 0, 'from 0.1'),
    ('rate', inf, 'to 1000'), ('rate', 1e-320, 'from 0.1'), ('rate', 1e-9, 'from 0.1'),
    ('timeout', -1, 'from 0 to'), ('timeout', 1e-9, '0 (never), or at least 0.01 s'),
    ('max_linear_speed', 0, 'from 0.001'), ('max_angular_speed', 'fast', 'speed'),
    ('wheel_radius', [], 'radius'), ('wheel_radius', 1e-320, 'from 0.001'),
    ('base_frame_id', '', 'frame'), ('base_frame_id', 7, 'frame'),
    ('base_frame_id', 'odom', 'other than odom_frame_id'),
    ('left_wheel', '', 'the name of a joint'), ('left_wheel', None, 'the name of a joint'),
    ('right_wheel', 7, 'a joint'), ('right_wheel', ['front', 'rear'], 'the name of a joint'),
    ('left_wheel', 'left wheel', 'the name of a joint'),
    ('left_wheel', 'r\u00e4d', 'letters, digits'), ('right_wheel', 'two\nlines', 'the name of a joint'),
    ('right_wheel', 'base_l_wheel_joint', 'other than left_wheel'),
    ('left_wheel', 'base_r_wheel_joint', 'other than right_wheel'),
    ('type', 'follow_controller', 'one of diff_controller')])
def test_an_invalid_value_is_named_with_its_key_and_what_is_expected(key, value, expected):
    params = load('turtlebot.yaml')
    params['controllers']['base_controller'][key] = value
    with pytest.raises(ConfigError) as error:
        read_robot(params)
    text = str(error.value)
    assert text.startswith(f'controllers/base_controller/{key}: {value!r}')
    assert expected in text and '\n' not in text


@pytest.mark.parametrize('path', [('controllers',), ('controllers', 'base_controller', 'base_width'),
                                  ('controllers', 'base_controller', 'type')])
def test_a_missing_key_is_named(path):
    params = load('turtlebot.yaml')
    parent = params
    for key in path[:-1]:
        parent = parent[key]
    del parent[path[-1]]
    with pytest.raises(ConfigError, match=f"^{'/'.join(path)}: missing"):
        read_robot(params)


@pytest.mark.parametrize('params', [
    7, [], 'text', {'controllers': 'base'}, {'controllers': {}}, {'controllers': {'base': None}},
    {'controllers': {'a': {'type': 'diff_controller'}, 'b': {'type': 'diff_controller'}}},
    {'controllers': {'arm': {'type': 'follow_controller'}, 'head': {}}}])
def test_a_configuration_without_one_base_is_rejected(params):
    with pytest.raises(ConfigError, match='expected'):
        read_robot(params)


@pytest.mark.parametrize('joint, expected', [
    ({'min_angle': 10, 'max_angle': 10}, 'below max_angle'), ({'max_speed': 0}, 'from 0.01'),
    ({'min_angle': nan}, 'an angle from -36000 to 36000 in degrees'), (None, 'mapping')])
def test_an_invalid_joint_is_rejected(joint, expected):
    params = load('turtlebot.yaml')
    params['joints'] = {'pan': joint}
    with pytest.raises(ConfigError, match=expected):
        read_robot(params)


@pytest.mark.parametrize('name', ['my joint', 'base_l_wheel_joint', 'gel\u00e4nk'])
def test_a_joint_needs_a_name_of_its_own_that_can_be_a_topic(name):
    params = load('turtlebot.yaml')
    params['joints'] = {name: {}}
    with pytest.raises(ConfigError, match=f"'{name}'.*expected a name"):
        read_robot(params)


def test_wheels_have_the_names_of_the_urdf_file():
    params = load('pi_robot.yaml')
    assert read_robot(params).wheel_joints == ('base_l_wheel_joint', 'base_r_wheel_joint')
    params['controllers']['base_controller'].update(left_wheel='wheel-left.joint', right_wheel='base/right_wheel')
    params['joints']['base_l_wheel_joint'] = {}     # this name is free, because the wheels have other names
    robot = read_robot(params)
    assert robot.wheel_joints == ('wheel-left.joint', 'base/right_wheel') and robot.unknown == []


def test_sim_false_is_rejected():
    with pytest.raises(ConfigError, match='sim: False'):
        read_robot(dict(load('turtlebot.yaml'), sim=False))


def test_reading_does_not_change_the_mapping():
    for path in glob.glob(os.path.join(CONFIG, '*.yaml')):
        params = load(os.path.basename(path))
        before = copy.deepcopy(params)
        read_robot(params)
        assert params == before


def test_keys_that_are_given_replace_the_defaults():
    robot = describe({'rate': 25, 'timeout': 0.25, 'max_linear_speed': 0.5, 'max_angular_speed': 2.0,
                      'wheel_radius': 0.05, 'left_wheel': 'a', 'right_wheel': 'b'},
                     {'min_angle': 10, 'max_angle': 20, 'max_speed': 5}, publish_tf=False)
    assert (robot.rate, robot.timeout, robot.wheel_radius) == (25, SECOND // 4, 0.05)
    assert describe({'timeout': 0}).timeout == 0 and describe({'timeout': 0.01}).timeout == SECOND // 100
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
