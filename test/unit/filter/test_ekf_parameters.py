"""The parameters of the filter reach it in its units, and its frames have the prefix."""
from math import radians
from unittest.mock import MagicMock

from nav_msgs.msg import Odometry
import pytest
import rospy

from rbx1_nav.base.surfaces import load_surface
from rbx1_nav.filter import ekf_parameters as module
from rbx1_nav.filter.conversions import frames_of
from rbx1_nav.filter.ekf_parameters import read_parameters
from rbx1_nav.filter.input_checks import RejectedMessage
from rbx1_nav.filter.priors import UNKNOWN_FLOOR, Bounds, priors
from rbx1_nav.node.config import ConfigError
from sample_priors import SURFACES

BASE = 'base_footprint_frame'


def test_the_limits_of_the_robot():
    found = read_parameters(dict(max_speed=1.0, max_turn_rate=2.0, max_angular_acceleration=3.0, gyro_bias=4.0,
                                 gyro_scale_error=0.05)).limits
    assert found._asdict() == dict(max_speed=1.0, max_turn_rate=2.0, max_angular_acceleration=3.0,
                                   gyro_bias=radians(4), gyro_scale_error=0.05)
    assert read_parameters({}).limits == pytest.approx(Bounds())


@pytest.mark.parametrize('params, output, base, default', [
    ({}, 'odom_combined', '', 'base_footprint'), ({BASE: 'base'}, 'odom_combined', 'base', 'base'),
    (dict(tf_prefix='r'), 'r/odom_combined', '', 'r/base_footprint'),
    ({'tf_prefix': 'r', 'output_frame': 'map', BASE: 'base'}, 'r/map', 'r/base', 'r/base'),
    ({'tf_prefix': 'r', 'output_frame': '/map', BASE: '/base'}, 'map', 'base', 'base')])
def test_frames(params, output, base, default):
    found = read_parameters(params)
    assert (found.output_frame, found.base_footprint_frame, found.default_base_frame) == (output, base, default)


@pytest.mark.parametrize('params, child, base', [
    ({}, 'base_link', 'base_link'), ({}, '/base_link', 'base_link'), ({}, '', 'base_footprint'),
    (dict(tf_prefix='r'), '', 'r/base_footprint'), ({BASE: 'mine'}, 'base_link', 'mine')])
def test_the_frame_of_the_robot(params, child, base):
    message = Odometry(child_frame_id=child)
    message.header.frame_id = '/odom'
    assert frames_of(message, read_parameters(params)) == ('odom', base)
    message.header.frame_id = ''
    with pytest.raises(RejectedMessage, match="header.frame_id: '': expected the name of a frame"):
        frames_of(message, read_parameters(params))
    message.header.frame_id, message.child_frame_id = 'odom', 'map'
    if BASE not in params:
        with pytest.raises(RejectedMessage, match='a frame other than output_frame'):
            frames_of(message, read_parameters(dict(params, output_frame='/map')))


def test_what_is_not_supported_is_logged(monkeypatch):
    names, lines = ('vo_used', 'gps_used', 'debug', 'self_diagnose'), []
    monkeypatch.setattr(rospy, 'logwarn', lambda form, *values: lines.append(form % values))
    monkeypatch.setattr(module, 'find_prefix', lambda: None)
    for value in False, True:
        monkeypatch.setattr(module, 'stored_params', lambda wanted=value: dict.fromkeys(names, wanted))
        module.load_parameters()
        assert len(lines) == 4 * value
    assert lines == ['vo_used: visual odometry is not supported and not used', 'gps_used: GPS is not supported and not '
                     'used', 'debug: no files are written; record the topics with rosbag',
                     'self_diagnose: see /diagnostics']


@pytest.mark.parametrize('params, text', [
    (dict(odom_used=False), 'odom_used: False: expected true'), ({'output_frame': 'map', BASE: 'map'}, 'other than'),
    (dict(tf_prefix=7), 'tf_prefix: 7: expected the name'), (dict(surface='sand'), 'sand.*; or auto, or unknown'),
    (dict(max_speed=0), 'max_speed: 0: expected a speed from 0.01 to 1000 in m/s'),
    (dict(gyro_bias='small'), "gyro_bias: 'small': expected a bias from 0.01 to 1000 in degrees/s")])
def test_what_is_rejected(monkeypatch, params, text):
    monkeypatch.setattr(module.resources, 'surfaces', lambda: SURFACES)     # also without a workspace
    with pytest.raises(ConfigError, match=text):
        read_parameters(params)


@pytest.mark.parametrize('name, params, floor', [
    ('low_ply_carpet', {}, 'low_ply_carpet'), ('auto', {'/base/surface': 'hard_floor'}, 'hard_floor'),
    ('auto', {}, 'unknown'), ('auto', {'/base/surface': 'sand'}, 'unknown')])
def test_the_assumed_floor_is_that_of_the_parameter_or_of_a_simulated_base(monkeypatch, name, params, floor):
    lines, server = [], MagicMock()
    server.return_value.__enter__.return_value.param = params.get
    monkeypatch.setattr(module, 'Server', server)
    monkeypatch.setattr(module, 'private_namespace', lambda base, *_: base)
    monkeypatch.setattr(module.resources, 'surfaces', lambda: SURFACES)
    prior = module.find_prior(name, '/base', lambda _, text: lines.append(text))
    assert lines[-1] == f'Initially assumed floor: {floor}' and len(lines) == 1 + ('sand' in params.values())
    assert prior == (UNKNOWN_FLOOR if floor == 'unknown' else priors(load_surface(floor, SURFACES)))


@pytest.mark.parametrize('wallclock, ahead', [(True, 0.5), (False, 60)])
def test_the_filter_has_the_parameters_of_the_node(monkeypatch, wallclock, ahead):
    monkeypatch.setattr(rospy.rostime, 'is_wallclock', lambda: wallclock)
    parameters = read_parameters(dict(surface='unknown', sensor_timeout=0.25, imu_used=False, max_speed=2))
    found = module.make_filter(parameters, '/base', lambda *_: None, None)
    assert found.timeout == found.arrivals.timeout == 250000000 and not found.gyro_used
    assert found.limits.max_speed == 2.0 and found.arrivals.max_lead == ahead * 10 ** 9 and found.arrivals.clock
