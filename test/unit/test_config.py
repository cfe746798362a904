"""The YAML files that ArbotiX users have: read as they are, and told apart from nonsense in one line."""
import copy
import glob
import os
from math import inf, nan, radians

import pytest
import yaml

from rbx1_nav.units import SECOND
from rbx1_nav.config import ConfigError
from rbx1_nav.model.robot import read_robot

CONFIG = os.path.join(os.path.dirname(__file__), '..', '..', 'config')


def load(name):
    with open(os.path.join(CONFIG, name)) as file:
        return yaml.safe_load(file)


def test_turtlebot():
    config = read_robot(load('turtlebot.yaml'))
    assert (config.name, config.odom_frame_id, config.base_frame_id) == ('base_controller', 'odom', 'base_footprint')
    # the driver's own rate is for its hardware: the controller's is the odometry's
    assert (config.base_width, config.rate, config.timeout) == (0.26, 50, SECOND)
    assert config.limits == (inf, inf) and config.publish_tf is True
    assert config.joints == [] and config.unknown == []
    assert {'port', 'rate', 'controllers/base_controller/Kp'} <= set(config.ignored)


def test_pi_robot():
    config = read_robot(load('pi_robot.yaml'))
    assert config.base_frame_id == 'base_link' and config.unknown == []
    assert [joint.name for joint in config.joints] == [
        'arm_shoulder_pan_joint', 'arm_shoulder_lift_joint', 'arm_elbow_flex_joint', 'arm_wrist_flex_joint',
        'gripper_joint', 'head_pan_joint', 'head_tilt_joint']
    assert config.joints[-1].upper == radians(60) and config.joints[-1].max_speed == radians(90)


def test_old_frame_names_lose_their_slash():
    params = load('turtlebot.yaml')
    params['controllers']['base_controller'].update(base_frame_id='/base_footprint', odom_frame_id='/odom')
    config = read_robot(params)
    assert (config.odom_frame_id, config.base_frame_id) == ('odom', 'base_footprint')


def test_unknown_keys_are_told():
    params = load('turtlebot.yaml')
    params['controllers']['base_controller']['time_out'] = 2
    assert read_robot(params).unknown == ['controllers/base_controller/time_out']


@pytest.mark.parametrize('key, value, expected', [
    ('base_width', 0, 'above 0'), ('base_width', '0.26', 'width'), ('base_width', nan, 'finite'),
    ('base_width', True, 'width'), ('rate', -5, 'above 0'), ('rate', 0, 'above 0'), ('rate', inf, 'up to 1000'),
    ('timeout', -1, '0 (never)'), ('max_linear_speed', 0, 'above 0'), ('max_angular_speed', 'fast', 'speed'),
    ('wheel_radius', [], 'radius'), ('base_frame_id', '', 'frame'), ('base_frame_id', 7, 'frame'),
    ('base_frame_id', 'odom', 'other than odom_frame_id'),
    ('type', 'follow_controller', 'one of: diff_controller')])
def test_a_bad_value_is_named_with_its_key_and_what_is_expected(key, value, expected):
    params = load('turtlebot.yaml')
    params['controllers']['base_controller'][key] = value
    with pytest.raises(ConfigError) as error:
        read_robot(params)
    text = str(error.value)
    assert text.startswith('controllers/base_controller/%s: %r' % (key, value))
    assert expected in text and '\n' not in text


@pytest.mark.parametrize('path', [('controllers',), ('controllers', 'base_controller', 'base_width'),
                                  ('controllers', 'base_controller', 'type')])
def test_a_missing_key_is_named(path):
    params = load('turtlebot.yaml')
    parent = params
    for key in path[:-1]:
        parent = parent[key]
    del parent[path[-1]]
    with pytest.raises(ConfigError, match='^%s: missing' % '/'.join(path)):
        read_robot(params)


@pytest.mark.parametrize('params', [
    7, [], 'text', {'controllers': 'base'}, {'controllers': {}}, {'controllers': {'base': None}},
    {'controllers': {'a': {'type': 'diff_controller'}, 'b': {'type': 'diff_controller'}}}])
def test_what_is_no_configuration_at_all(params):
    with pytest.raises(ConfigError, match='expected'):
        read_robot(params)


@pytest.mark.parametrize('joint, expected', [
    ({'min_angle': 10, 'max_angle': -10}, 'under max_angle'), ({'max_speed': 0}, 'above 0'),
    ({'min_angle': nan}, 'finite angle'), (None, 'mapping')])
def test_bad_joints(joint, expected):
    params = load('turtlebot.yaml')
    params['joints'] = {'pan': joint}
    with pytest.raises(ConfigError, match=expected):
        read_robot(params)


def test_a_joint_needs_a_name_that_can_be_a_topic():
    params = load('turtlebot.yaml')
    params['joints'] = {'my joint': {}}
    with pytest.raises(ConfigError, match="'my joint'.*expected a name"):
        read_robot(params)
    params['joints'] = {'base_l_wheel_joint': {}}
    with pytest.raises(ConfigError, match="'base_l_wheel_joint'.*expected a name"):
        read_robot(params)


def test_a_number_that_yaml_takes_for_text_gets_a_hint():
    params = load('turtlebot.yaml')
    params['controllers']['base_controller']['base_width'] = '1e-1'
    with pytest.raises(ConfigError, match='write it like 1.0e-3'):
        read_robot(params)


def test_sim_false_is_no_simulation():
    with pytest.raises(ConfigError, match='sim: False'):
        read_robot(dict(load('turtlebot.yaml'), sim=False))


def test_reading_does_not_change_what_is_read():
    for path in glob.glob(os.path.join(CONFIG, '*.yaml')):
        params = load(os.path.basename(path))
        before = copy.deepcopy(params)
        read_robot(params)
        assert params == before
