"""A robot as the YAML files of ArbotiX users describe it."""
from __future__ import annotations

from math import inf, radians
import re
from typing import Container, NamedTuple

from rbx1_nav.config import ConfigError, Section, YamlValue, show, show_name
from rbx1_nav.parameters import elsewhere, flag, frame, number, read
from rbx1_nav.robot.joints import Joint
from rbx1_nav.units import SECOND

# what only the hardware needs: accepted and ignored
DRIVER_KEYS = {'port', 'baud', 'rate', 'sync_write', 'sync_read', 'read_rate', 'write_rate'}
CONTROLLER_KEYS = {'ticks_meter', 'Kp', 'Kd', 'Ki', 'Ko', 'accel_limit'}
JOINT_KEYS = {'id', 'neutral', 'invert', 'ticks', 'range'}

MAX_ANGLE = 36000   # degrees: a joint of 100 turns
MIN_TIMEOUT = 0.01  # s

# the keys of diff_drive_controller, and the names in this package's URDF files
WHEEL_JOINTS = {'left_wheel': 'base_l_wheel_joint', 'right_wheel': 'base_r_wheel_joint'}

PARAMETERS = (
    elsewhere('controllers', 'one diff_controller', note='see below'),
    elsewhere('joints', 'servos', 'none', note='see below'),
    flag('publish_tf', True, 'whether to publish the transform to the base frame', note='false if another node does'),
    flag('sim', True, 'must be true: this base is a simulation'))

CONTROLLER = (
    elsewhere('type', '`diff_controller`'),
    number('base_width', None, 'm', 'distance between the wheels', 0.001, 100, 'a width', required=True),
    frame('base_frame_id', 'base_link', 'frame of the robot'),
    frame('odom_frame_id', 'odom', 'frame of the odometry'),
    number('rate', 50.0, 'Hz', 'of the odometry; on simulated time at most 50', 0.1, 1000, 'a rate'),
    number('timeout', 1.0, 's', f'a command of this age stops the base; at least {MIN_TIMEOUT:g}, or 0: never', 0, 1e6,
           'a time'),
    number('max_linear_speed', inf, 'm/s', 'commands are clamped to it', 0.001, 1000, 'a speed', shown='no limit'),
    number('max_angular_speed', inf, 'rad/s', 'the same in a turn', 0.001, 1000, 'a speed', shown='no limit'),
    number('wheel_radius', 0.033, 'm', 'turns wheel travel into joint angles', 0.001, 100, 'a radius'),
    elsewhere('left_wheel', 'joint of the left wheel in `joint_states`, as the URDF file names it',
              WHEEL_JOINTS['left_wheel']),
    elsewhere('right_wheel', 'joint of the right wheel', WHEEL_JOINTS['right_wheel']))

JOINT = (
    number('min_angle', -150.0, 'degrees', 'lower limit', -MAX_ANGLE, MAX_ANGLE, 'an angle'),
    number('max_angle', 150.0, 'degrees', 'upper limit', -MAX_ANGLE, MAX_ANGLE, 'an angle'),
    number('max_speed', 90.0, 'degrees/s', 'speed at which the joint moves to its goal', 0.01, MAX_ANGLE, 'a speed'))


class Limits(NamedTuple):
    """Maximum speeds; infinite where there is no limit."""

    linear: float   # m/s
    angular: float  # rad/s


class Robot(NamedTuple):
    """A robot's configuration. hardware, unknown: sorted names of keys without effect."""

    name: str
    odom_frame_id: str
    base_frame_id: str
    base_width: float       # m
    wheel_radius: float     # m
    rate: float             # Hz
    timeout: int            # ns
    limits: Limits
    publish_tf: bool
    joints: list[Joint]
    wheel_joints: tuple[str, str]   # names of the joints of the left and the right wheel
    hardware: list[str]     # keys that only hardware needs
    unknown: list[str]      # keys of a controller or joint that are unknown


def read_joint(name: str, section: Section) -> Joint:
    """A Joint from its Section, which is in degrees. Raises ConfigError."""
    values = read(JOINT, section)
    lower, upper = values['min_angle'], values['max_angle']
    if lower >= upper:
        raise ConfigError(f"{section.path('min_angle')}: {lower!r}: expected an angle below max_angle, {upper!r}")
    return Joint(name, radians(lower), radians(upper), radians(values['max_speed']))


def read_wheel_joints(section: Section, servos: Container[str] = ()) -> tuple[str, str]:
    """(left, right) names of the wheels' joints, from the Section that has their keys. Raises ConfigError.

    servos: names of other joints, which neither key may have. A default is not compared with them.
    """
    names = []
    for key, default in WHEEL_JOINTS.items():
        name = section.get(key, default)
        # more characters than a servo's name may have: no topic has this one
        if not (isinstance(name, str) and re.fullmatch(r'[A-Za-z][\w./-]{0,199}', name, re.ASCII)):
            raise ConfigError(f'{section.path(key)}: {show(name)}: expected the name of a joint: '
                              'a letter, then up to 199 letters, digits or _ - . /')
        if key in section.values and name in servos:
            raise ConfigError(f'{section.path(key)}: {show(name)}: expected the joint of a wheel, '
                              'which is not one of joints')
        names.append(name)
    left, right = names
    if left == right:
        key, other = 'right_wheel', 'left_wheel'
        if key not in section.values:   # the other one has its default
            key, other = other, key
        raise ConfigError(f'{section.path(key)}: {show(left)}: expected a joint other than {other}')
    return left, right


def read_robot(params: YamlValue) -> Robot:
    """The Robot that a dictionary of ArbotiX parameters describes. Raises ConfigError."""
    top = Section(params, hardware=DRIVER_KEYS)
    values = read(PARAMETERS, top)
    if not values['sim']:
        raise ConfigError('sim: False: expected true, this base is a simulation')

    controllers = top.section('controllers', expected='a mapping with one diff_controller')
    if len(controllers.values) != 1:
        raise ConfigError(f'controllers: {show(list(controllers.values))}: '
                          'expected exactly one, of type diff_controller')
    name, = controllers.values
    base = controllers.section(name, CONTROLLER_KEYS)
    kind = base.get('type', expected='diff_controller')
    if kind != 'diff_controller':
        raise ConfigError(f"{base.path('type')}: {show(kind)}: "
                          'unknown controller type, expected one of: diff_controller')
    sections = [base]

    joints = []
    all_joints = top.section('joints', default={})
    wheel_joints = read_wheel_joints(base, all_joints.values)
    for joint in all_joints.values:
        if not (isinstance(joint, str) and re.fullmatch(r'[A-Za-z]\w*', joint, re.ASCII)) or joint in wheel_joints:
            raise ConfigError(f'joints: {show(joint)}: expected a name of letters, digits and underscores, '
                              f"other than {' and '.join(wheel_joints)}")
        section = all_joints.section(joint, JOINT_KEYS)
        joints.append(read_joint(joint, section))
        sections.append(section)

    keys = read(CONTROLLER, base)
    timeout = keys['timeout']
    if 0 < timeout < MIN_TIMEOUT:   # less would become 0, which is no timeout at all
        raise ConfigError(f"{base.path('timeout')}: {timeout!r}: expected 0 (never), or at least {MIN_TIMEOUT:g} s")
    robot = Robot(
        name=show_name(name),
        odom_frame_id=keys['odom_frame_id'],
        base_frame_id=keys['base_frame_id'],
        base_width=keys['base_width'],
        wheel_radius=keys['wheel_radius'],
        rate=keys['rate'],
        timeout=round(SECOND * timeout),
        limits=Limits(keys['max_linear_speed'], keys['max_angular_speed']),
        publish_tf=values['publish_tf'],
        joints=joints,
        wheel_joints=wheel_joints,
        hardware=sorted(key for section in [top, *sections] for key in section.ignored()),
        unknown=sorted(key for section in sections for key in section.unknown()))
    if robot.odom_frame_id == robot.base_frame_id:
        raise ConfigError(f"{base.path('base_frame_id')}: {show(robot.base_frame_id)}: "
                          'expected a frame other than odom_frame_id')
    return robot
