"""Reads the description of a robot from parameters in the format of the ArbotiX driver, with its joints."""
from __future__ import annotations

from math import degrees, inf, isfinite, radians
import re
from typing import Container, NamedTuple

from rbx1_nav.base.units import SECOND, clamp
from rbx1_nav.node.config import ConfigError, Section, YamlValue, load_yaml, show, show_name
from rbx1_nav.node.parameters import custom, elsewhere, flag, frame, number, read

# keys that only the hardware needs: accepted and ignored
DRIVER_KEYS = {'port', 'baud', 'rate', 'sync_write', 'sync_read', 'read_rate', 'write_rate'}
CONTROLLER_KEYS = {'ticks_meter', 'Kp', 'Kd', 'Ki', 'Ko', 'accel_limit'}
JOINT_KEYS = {'id', 'neutral', 'invert', 'ticks', 'range'}

MAX_ANGLE = 36000   # degrees: a joint that makes 100 turns
MIN_TIMEOUT = 0.01  # s

# the keys of diff_drive_controller, and the joint names in this package's URDF files
WHEEL_JOINTS = {'left_wheel': 'base_l_wheel_joint', 'right_wheel': 'base_r_wheel_joint'}

MODEL = custom('model', '', 'URDF file that the launch file shows; for messages', str, shown='none')

PARAMETERS = (
    elsewhere('controllers', 'mapping with one diff_controller', note='see below'),
    elsewhere('joints', 'servos', 'none', note='see below'),
    flag('publish_tf', True, 'whether to publish the transform to the base frame',
         note='false if another node publishes it'),
    MODEL,
    flag('sim', True, 'whether the base is a simulation; must be true'))

CONTROLLER = (
    elsewhere('type', 'controller type: `diff_controller`'),
    number('base_width', None, 'm', 'distance between the wheels', 0.001, 100, 'a width', required=True),
    frame('base_frame_id', 'base_link', 'frame of the robot'),
    frame('odom_frame_id', 'odom', 'frame of the odometry'),
    number('rate', 50.0, 'Hz', 'publish rate of the odometry; at most 50 on simulated time', 0.1, 1000, 'a rate'),
    number('timeout', 1.0, 's', f'command age at which the base stops; at least {MIN_TIMEOUT:g}, or 0 for no timeout',
           0, 1e6, 'a time'),
    number('max_linear_speed', inf, 'm/s', 'speed to which commands are clamped', 0.001, 1000, 'a speed',
           shown='no limit'),
    number('max_angular_speed', inf, 'rad/s', 'turn rate to which commands are clamped', 0.001, 1000, 'a speed',
           shown='no limit'),
    number('wheel_radius', 0.033, 'm', 'wheel radius, for the joint angles of the wheels', 0.001, 100,
           'a radius'),
    elsewhere('left_wheel', 'left wheel joint, as named in the URDF file',
              WHEEL_JOINTS['left_wheel']),
    elsewhere('right_wheel', 'right wheel joint', WHEEL_JOINTS['right_wheel']))

JOINT = (
    number('min_angle', -150.0, 'degrees', 'lower limit', -MAX_ANGLE, MAX_ANGLE, 'an angle'),
    number('max_angle', 150.0, 'degrees', 'upper limit', -MAX_ANGLE, MAX_ANGLE, 'an angle'),
    number('max_speed', 90.0, 'degrees/s', 'speed at which the joint moves to its goal', 0.01, MAX_ANGLE, 'a speed'))


class Joint:
    """A joint that moves toward its goal at its maximum speed and stays within its limits.

    Radians and seconds.
    """

    def __init__(self, name: str, lower: float, upper: float, max_speed: float) -> None:
        """lower, upper: limits, rad; max_speed: rad/s."""
        self.name = name
        self.lower = lower
        self.upper = upper
        self.max_speed = max_speed
        self.position = self.goal = min(max(0.0, lower), upper)
        self.velocity = 0.0

    def command(self, goal: float) -> None:
        """Set the goal (rad), limited to the joint's range. Raises ValueError if it is not finite."""
        if not isfinite(goal):
            raise ValueError(f'{goal}: expected a finite angle in rad')
        self.goal = min(max(goal, self.lower), self.upper)

    def advance(self, duration: float) -> None:
        """Move for `duration` seconds."""
        step = clamp(self.goal - self.position, self.max_speed * duration)
        self.velocity = step / duration if duration > 0 else 0.0
        # stop exactly at the goal, without a rounding error
        self.position = self.goal if step == self.goal - self.position else self.position + step


class Limits(NamedTuple):
    """Maximum speeds; infinite where there is no limit."""

    linear: float   # m/s
    angular: float  # rad/s


class Robot(NamedTuple):
    """The configuration of a robot.

    hardware, unknown: sorted names of keys that have no effect.
    """

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
    model: str              # URDF file that the launch file shows, or ''
    hardware: list[str]     # keys that only hardware needs
    unknown: list[str]      # other controllers, and keys of a controller or joint that are unknown


def read_joint(name: str, section: Section) -> Joint:
    """Return the Joint that a Section describes in degrees. Raises ConfigError."""
    values = read(JOINT, section)
    lower, upper = values['min_angle'], values['max_angle']
    if lower >= upper:
        raise ConfigError(f"{section.path('min_angle')}: {lower!r}: expected an angle below max_angle, {upper!r}")
    return Joint(name, radians(lower), radians(upper), radians(values['max_speed']))


def find_smaller_range(section: Section, joint: Joint) -> list[str]:
    """Return a text if arbotix_driver would limit a Joint to a smaller range, because its servo ends there; [] if not.

    The range follows from ticks, neutral, range and invert as in DynamixelServo of arbotix_python 0.11.0. Raises
    ConfigError.
    """
    ticks = section.number('ticks', 1, 1e6, 1024, 'a number of ticks')
    neutral = section.number('neutral', 0, 1e6, ticks / 2, 'a number of ticks')
    tick = section.number('range', 0.001, MAX_ANGLE, 360 if ticks == 4096 else 300, 'an angle', 'degrees') / ticks
    ends = [-neutral * tick, (ticks - neutral) * tick]
    lower, upper = sorted(-each for each in ends) if section.flag('invert', False) else ends
    if lower <= degrees(joint.lower) + tick and degrees(joint.upper) - tick <= upper:
        return []
    return [f"{section.path('neutral')} (with arbotix_driver, the joint moves from {lower:.1f} to {upper:.1f} degrees)"]


def read_wheel_joints(section: Section, servos: Container[str] = ()) -> tuple[str, str]:
    """Return the (left, right) names of the wheel joints from the Section that has their keys. Raises ConfigError.

    servos: names of other joints, which neither key may have as its value. A default is not compared with them.
    """
    names = []
    for key, default in WHEEL_JOINTS.items():
        name = section.get(key, default)
        # more characters are allowed than in a servo's name, because no topic contains this name
        if not (isinstance(name, str) and re.fullmatch(r'[A-Za-z][\w./-]{0,199}', name, re.ASCII)):
            raise ConfigError(f'{section.path(key)}: {show(name)}: expected the name of a joint: '
                              'a letter, then up to 199 letters, digits or _ - . /')
        if key in section.values and name in servos:
            raise ConfigError(f'{section.path(key)}: {show(name)}: expected a wheel joint, '
                              'not a servo listed in joints')
        names.append(name)
    left, right = names
    if left == right:
        key, other = 'right_wheel', 'left_wheel'
        if key not in section.values:   # the right wheel has its default name
            key, other = other, key
        raise ConfigError(f'{section.path(key)}: {show(left)}: expected a joint other than {other}')
    return left, right


def load_robot(path: str) -> Robot:
    """Return the Robot that an ArbotiX YAML file describes. Raises ConfigError."""
    try:
        return read_robot(load_yaml(path))
    except ConfigError as error:
        raise ConfigError(f'{show_name(path)}: {error}') from None


def read_robot(params: YamlValue) -> Robot:
    """Return the Robot that a dictionary of ArbotiX parameters describes. Raises ConfigError."""
    top = Section(params, hardware=DRIVER_KEYS)
    values = read(PARAMETERS, top)
    if not values['sim']:
        raise ConfigError('sim: False: expected true, because this base is a simulation')

    controllers = top.section('controllers', expected='a mapping with one diff_controller')
    kinds = {each: value.get('type') if isinstance(value, dict) else None for each, value in controllers.values.items()}
    bases = [each for each, kind in kinds.items() if kind == 'diff_controller' or len(kinds) == 1]
    if len(bases) != 1:
        raise ConfigError(f'controllers: {show(kinds)}: expected exactly one of type diff_controller')
    name, = bases
    base = controllers.section(name, CONTROLLER_KEYS)
    base.choice('type', ('diff_controller',), None)
    # such as of an arm
    others = [f'{controllers.path(each)} ({show_name(kind)})' for each, kind in kinds.items() if each != name]
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
        others += find_smaller_range(section, joints[-1])
        sections.append(section)

    keys = read(CONTROLLER, base)
    timeout = keys['timeout']
    if 0 < timeout < MIN_TIMEOUT:   # a tiny one would be rounded to 0, which means no timeout
        raise ConfigError(f"{base.path('timeout')}: {timeout!r}: expected 0 (never), or at least {MIN_TIMEOUT:g} s")
    robot = Robot(
        name=show_name(name),
        odom_frame_id=keys['odom_frame_id'],
        base_frame_id=keys['base_frame_id'],
        base_width=keys['base_width'],
        wheel_radius=keys['wheel_radius'],
        rate=keys['rate'],
        timeout=round(SECOND * timeout),
        limits=Limits(linear=keys['max_linear_speed'], angular=keys['max_angular_speed']),
        publish_tf=values['publish_tf'],
        joints=joints,
        wheel_joints=wheel_joints,
        model=values['model'],
        hardware=sorted(key for section in [top, *sections] for key in section.ignored()),
        unknown=sorted([*others, *(key for section in sections for key in section.unknown())]))
    if robot.odom_frame_id == robot.base_frame_id:
        raise ConfigError(f"{base.path('base_frame_id')}: {show(robot.base_frame_id)}: "
                          'expected a frame other than odom_frame_id')
    return robot
