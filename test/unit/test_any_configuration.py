"""Any configuration is either accepted, with finite values, or rejected with a one-line message."""
import glob
import os
from math import isfinite

from hypothesis import given, settings
from hypothesis import strategies as st
import yaml

from rbx1_nav.base.robot_parameters import read_robot
from rbx1_nav.base.schedule import Schedule
from rbx1_nav.base.surfaces import KEYS, Surface, read_surface
from rbx1_nav.filter.ekf_parameters import read_parameters
from rbx1_nav.node.config import ConfigError
from rbx1_nav.simulation.simulated_base import make_base, make_wheels_and_gyro
from rbx1_nav.simulation.slip import draw_run, read_seed

CONFIG = os.path.join(os.path.dirname(__file__), '..', '..', 'config')
ROBOTS, SURFACES = ([yaml.safe_load(open(path)) for path in sorted(glob.glob(os.path.join(CONFIG, *pattern)))]
                    for pattern in (['*.yaml'], ['surfaces', '*d*_*.yaml']))
ROBOTS.append({'controllers': {'base': {'type': 'diff_controller', 'base_width': 0.26, 'left_wheel': 'left',
                                        'right_wheel': 'right'}}, 'joints': {'pan': {}}})
FILTER = ['freq', 'sensor_timeout', 'diagnostic_period', 'publish_tf', 'imu_used', 'output_frame', 'odom_used',
          'vo_used', 'surface', 'max_speed', 'max_turn_rate', 'max_angular_acceleration', 'gyro_bias',
          'gyro_scale_error']
NUMBERS = st.one_of(st.floats(), st.floats(-1e3, 1e3), st.integers(), st.sampled_from([
    0, 1, -1, 1e-320, 5e-324, 1e-9, 1e308, 10 ** 400, -10 ** 400, 2 ** 31, 2 ** 63]))
TEXTS = st.one_of(st.text(), st.sampled_from(['1e5', 'two\nlines', 'a\x1b[1m', '\x00', 'odom', '/odom', 'x' * 10 ** 4]))
SCALARS = st.one_of(st.none(), st.booleans(), NUMBERS, TEXTS, st.binary(max_size=5), st.dates())
VALUES = st.recursive(SCALARS, lambda values: st.one_of(
    st.lists(values, max_size=3), st.dictionaries(st.one_of(TEXTS, NUMBERS), values, max_size=3)), max_leaves=8)

ANY = st.one_of(NUMBERS, TEXTS, VALUES)
OPTIONAL = st.dictionaries(st.sampled_from(sorted(Surface._field_defaults)), st.floats(0, 1))


def with_change(data, mapping):
    """A copy of nested mappings in which one value or one key is replaced by an arbitrary one."""
    key = data.draw(st.sampled_from(sorted(mapping)))
    inner = mapping[key]
    if isinstance(inner, dict) and inner and data.draw(st.integers(0, 9)):
        return dict(mapping, **{key: with_change(data, inner)})
    if data.draw(st.integers(0, 3)):
        return dict(mapping, **{key: data.draw(ANY)})
    return {data.draw(st.one_of(TEXTS, NUMBERS)) if each == key else each: mapping[each] for each in mapping}


def one_line(text):
    """Whether a text is suitable as one line of a log."""
    return text.isprintable() and len(text) < 3000


def is_explained(error):
    """Whether a ConfigError is one line that says what is expected."""
    return one_line(str(error)) and 'expected' in str(error)


@settings(max_examples=200)
@given(st.data())
def test_a_robot(data):
    params = data.draw(VALUES) if not data.draw(st.integers(0, 9)) else with_change(data, data.draw(
        st.sampled_from(ROBOTS)))
    try:
        robot = read_robot(params)
    except ConfigError as error:
        assert is_explained(error)
        return
    assert all(map(one_line, robot.hardware + robot.unknown + [robot.name, robot.odom_frame_id, robot.base_frame_id,
                                                          *robot.wheel_joints]))
    assert len({*robot.wheel_joints, *(joint.name for joint in robot.joints)}) == 2 + len(robot.joints)
    base = make_base(robot, None, 0)
    base.command(0, 0.2, 1.0)
    base.advance(10 ** 9)
    assert all(map(isfinite, base.odometry.pose)) and isfinite(base.left / robot.wheel_radius)
    assert all(isfinite(value) for joint in robot.joints for value in (joint.lower, joint.upper, joint.max_speed))
    assert Schedule(robot.rate).period >= 10 ** 6


@given(st.data())
def test_a_surface(data):
    values = data.draw(VALUES) if not data.draw(st.integers(0, 9)) else with_change(data, dict(
        data.draw(st.sampled_from(SURFACES)), **data.draw(OPTIONAL)))
    try:
        surface = read_surface(values, data.draw(TEXTS))
    except ConfigError as error:
        assert is_explained(error)
        return
    assert surface is None or all(map(isfinite, surface[1:])) and all(map(isfinite, draw_run(surface, 0)))
    if surface is None:
        return
    assert len(surface) == 1 + len(KEYS)
    wheels, _ = make_wheels_and_gyro(0.26, surface, 0, 0.02)
    for command in (0.2, 1.0), (-0.1, 0.0), (0.0, 0.0):
        wheels.travel(*command, 1.0)
    assert all(map(isfinite, wheels.truth.pose)) and all(map(isfinite, wheels.uncertainty))


@given(st.dictionaries(st.sampled_from(FILTER), ANY, max_size=2))
def test_parameters_of_the_filter(params):
    try:
        values = read_parameters(params)
    except ConfigError as error:
        assert is_explained(error)
        return
    assert all(map(isfinite, (values.freq, values.sensor_timeout, values.diagnostic_period)))
    assert all(map(isfinite, values.limits))
    assert Schedule(values.freq).period >= 10 ** 6


@given(ANY)
def test_a_seed(value):
    try:
        assert 0 <= read_seed(value) < 2 ** 31
    except ConfigError as error:
        assert is_explained(error)
