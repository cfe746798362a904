"""A robot as the YAML files of ArbotiX users describe it."""
from collections import namedtuple
from math import inf, radians
import re

from rbx1_nav.config import ConfigError, Section, show, show_name
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

Limits = namedtuple('Limits', 'linear angular')
Limits.__doc__ = 'Maximum speeds, m/s and rad/s; infinite where there is no limit.'

Robot = namedtuple('Robot', 'name odom_frame_id base_frame_id base_width wheel_radius rate timeout limits publish_tf '
                            'joints wheel_joints hardware unknown')
Robot.__doc__ = """A robot's configuration. base_width and wheel_radius in m, rate in Hz, timeout in ns; limits: Limits;
joints: Joint objects; wheel_joints: names of the joints of the left and the right wheel; hardware, unknown: sorted names
of keys without effect: those that only hardware needs, and those of a controller or joint that are unknown."""


def read_joint(name, section):
    """A Joint from its Section, which is in degrees. Raises ConfigError."""
    lower = section.number('min_angle', -MAX_ANGLE, MAX_ANGLE, -150.0, 'an angle', 'degrees')
    upper = section.number('max_angle', -MAX_ANGLE, MAX_ANGLE, 150.0, 'an angle', 'degrees')
    if lower >= upper:
        raise ConfigError(f"{section.path('min_angle')}: {lower!r}: expected an angle below max_angle, {upper!r}")
    speed = section.number('max_speed', 0.01, MAX_ANGLE, 90.0, 'a speed', 'degrees per second')
    return Joint(name, radians(lower), radians(upper), radians(speed))


def read_wheel_joints(section, servos=()):
    """(left, right) names of the wheels' joints, from the Section that has their keys. Raises ConfigError.

    servos: names of other joints, which neither key may have. A default is not compared with them.
    """
    names = tuple(section.get(key, default) for key, default in WHEEL_JOINTS.items())
    for key, name in zip(WHEEL_JOINTS, names):
        if key not in section.values:
            continue
        # more characters than a servo's name may have: no topic has this one
        if not (isinstance(name, str) and re.fullmatch(r'[A-Za-z][\w./-]{0,199}', name, re.ASCII)):
            raise ConfigError('%s: %s: expected the name of a joint: a letter, then up to 199 letters, digits or _ - . /'
                              % (section.path(key), show(name)))
        if name in servos:
            raise ConfigError('%s: %s: expected the joint of a wheel, which is not one of joints'
                              % (section.path(key), show(name)))
    if names[0] == names[1]:
        key, other = 'right_wheel', 'left_wheel'
        if key not in section.values:   # the other one has its default
            key, other = other, key
        raise ConfigError(f'{section.path(key)}: {show(names[0])}: expected a joint other than {other}')
    return names


def read_robot(params):
    """The Robot that a dictionary of ArbotiX parameters describes. Raises ConfigError."""
    top = Section(params, hardware=DRIVER_KEYS)
    if not top.flag('sim', True):
        raise ConfigError('sim: False: expected true, this base is a simulation')
    publish_tf = top.flag('publish_tf', True)

    controllers = top.section('controllers', expected='a mapping with one diff_controller')
    if len(controllers.values) != 1:
        raise ConfigError('controllers: %s: expected exactly one, of type diff_controller'
                          % show(list(controllers.values)))
    name, = controllers.values
    base = controllers.section(name, CONTROLLER_KEYS)
    kind = base.get('type', expected='diff_controller')
    if kind != 'diff_controller':
        raise ConfigError('%s: %s: unknown controller type, expected one of: diff_controller'
                          % (base.path('type'), show(kind)))
    sections = [base]

    joints = []
    all_joints = top.section('joints', default={})
    wheel_joints = read_wheel_joints(base, all_joints.values)
    for joint in all_joints.values:
        if not (isinstance(joint, str) and re.fullmatch(r'[A-Za-z]\w*', joint, re.ASCII)) or joint in wheel_joints:
            raise ConfigError('joints: %s: expected a name of letters, digits and underscores, other than %s'
                              % (show(joint), ' and '.join(wheel_joints)))
        section = all_joints.section(joint, JOINT_KEYS)
        joints.append(read_joint(joint, section))
        sections.append(section)

    timeout = base.number('timeout', 0, 1e6, 1.0, 'a time', 's')
    if 0 < timeout < MIN_TIMEOUT:   # less would become 0, which is no timeout at all
        raise ConfigError(f"{base.path('timeout')}: {timeout!r}: expected 0 (never), or at least {MIN_TIMEOUT:g} s")
    fields = dict(
        name=show_name(name),
        odom_frame_id=base.frame('odom_frame_id', 'odom'),
        base_frame_id=base.frame('base_frame_id', 'base_link'),
        base_width=base.number('base_width', 0.001, 100, what='a width', unit='m'),
        wheel_radius=base.number('wheel_radius', 0.001, 100, 0.033, 'a radius', 'm'),
        rate=base.number('rate', 0.1, 1000, 50.0, 'a rate', 'Hz'),
        timeout=round(SECOND * timeout),
        limits=Limits(base.number('max_linear_speed', 0.001, 1000, inf, 'a speed', 'm/s'),
                      base.number('max_angular_speed', 0.001, 1000, inf, 'a speed', 'rad/s')),
        publish_tf=publish_tf,
        joints=joints,
        wheel_joints=wheel_joints)
    if fields['odom_frame_id'] == fields['base_frame_id']:
        raise ConfigError('%s: %s: expected a frame other than odom_frame_id'
                          % (base.path('base_frame_id'), show(fields['base_frame_id'])))
    return Robot(hardware=sorted(key for s in [top] + sections for key in s.ignored()),
                 unknown=sorted(key for s in sections for key in s.unknown()), **fields)
