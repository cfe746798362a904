"""Reads the YAML that ArbotiX users have for their robots, and says in one line what is wrong with it."""
from collections import namedtuple
from math import inf, isfinite, radians
import re
import reprlib

from rbx1_nav.base import SECOND, Limits
from rbx1_nav.joints import Joint

# what only the hardware needs: accepted, and ignored
DRIVER_KEYS = {'port', 'baud', 'rate', 'sync_write', 'sync_read', 'read_rate', 'write_rate'}
CONTROLLER_KEYS = {'ticks_meter', 'Kp', 'Kd', 'Ki', 'Ko', 'accel_limit'}
JOINT_KEYS = {'id', 'neutral', 'invert', 'ticks', 'range'}

WHEELS = ('base_l_wheel_joint', 'base_r_wheel_joint')

Config = namedtuple('Config', 'name odom_frame_id base_frame_id base_width wheel_radius rate timeout limits publish_tf '
                              'joints ignored unknown')
Config.__doc__ = """A robot. m, Hz, ns, and Limits; joints: Joint objects; ignored, unknown: keys without effect, sorted."""


class ConfigError(ValueError):
    """A value that makes no sense. The text names the key, the value and what is expected."""


def describe(value):
    """A value as the reader sees it in the YAML, with a hint where YAML took a number for text."""
    try:
        misread = isinstance(value, str) and isfinite(float(value))
    except ValueError:
        misread = False
    return repr(value) + (' (text to YAML, write it like 1.0e-3)' if misread else '')


def positive(key, value, expected='a finite number above 0'):
    """The value of a key, if it is a number above 0; else ConfigError."""
    return Section({key: value}, '').number(key, expected=expected)


class Section:
    """One mapping of the configuration. Remembers which keys were asked for, so that the others can be told of."""

    def __init__(self, values, key, hardware=()):
        self.key = key
        if not isinstance(values, dict):
            raise ConfigError('%s: %s: expected a mapping of keys to values'
                              % (key or 'configuration', reprlib.repr(values)))
        self.values = values
        self.hardware = set(hardware)
        self.known = set(hardware)

    def path(self, key):
        """The full name of a key, as rosparam would spell it."""
        return '%s/%s' % (self.key, key) if self.key else key

    def get(self, key, default=None, expected='a value'):
        """The value of a key; ConfigError if it is missing and has no default."""
        self.known.add(key)
        if key in self.values:
            return self.values[key]
        if default is None:
            raise ConfigError('%s: missing: expected %s' % (self.path(key), expected))
        return default

    def number(self, key, default=None, low=0.0, high=inf, expected='a finite number above 0', closed=False):
        """A finite number above `low` (not under it where `closed`) and not over `high`."""
        value = self.get(key, default, expected)
        # a bool is an int to Python, and a mistake here; the default itself may be infinite
        good = isinstance(value, (int, float)) and not isinstance(value, bool)
        if key in self.values or not good:
            good = good and isfinite(value) and (low < value or closed and low == value) and value <= high
        if not good:
            raise ConfigError('%s: %s: expected %s' % (self.path(key), describe(value), expected))
        return float(value)

    def flag(self, key, default):
        """True or false."""
        value = self.get(key, default)
        if not isinstance(value, bool):
            raise ConfigError('%s: %r: expected true or false' % (self.path(key), value))
        return value

    def frame(self, key, default):
        """A tf2 frame name; the leading slash of old files is taken off."""
        value = self.get(key, default)
        if not isinstance(value, str) or not re.match(r'^/?[^/\s]+(/[^/\s]+)*$', value):
            raise ConfigError('%s: %r: expected the name of a frame' % (self.path(key), value))
        return value.lstrip('/')

    def section(self, key, hardware=(), default=None, expected='a mapping'):
        """A mapping inside this one."""
        return Section(self.get(key, default, expected), self.path(key), hardware)

    def ignored(self):
        """Keys that only hardware needs."""
        return [self.path(key) for key in self.values if key in self.hardware]

    def unknown(self):
        """Keys that nobody asked for."""
        return [self.path(str(key)) for key in self.values if key not in self.known]


def read_joint(name, section):
    """A Joint from its section; degrees in the file, as ArbotiX has it."""
    lower = section.number('min_angle', -150.0, -inf, expected='a finite angle in degrees')
    upper = section.number('max_angle', 150.0, -inf, expected='a finite angle in degrees')
    if lower >= upper:
        raise ConfigError('%s: %r: expected an angle under max_angle, %r'
                          % (section.path('min_angle'), lower, upper))
    speed = section.number('max_speed', 90.0, expected='a finite speed above 0 in degrees per second')
    return Joint(name, radians(lower), radians(upper), radians(speed))


def read_config(params):
    """A Config from the dictionary that the node finds in its private namespace. Raises ConfigError."""
    top = Section(params, '', DRIVER_KEYS)
    if not top.flag('sim', True):
        raise ConfigError('sim: False: expected true, this base only simulates')
    publish_tf = top.flag('publish_tf', True)
    # read elsewhere, by the node and by diagnostic_updater
    top.known |= {'real_time_factor', 'diagnostic_period', 'surface', 'seed'}

    controllers = top.section('controllers', expected='a mapping with one diff_controller')
    if len(controllers.values) != 1:
        raise ConfigError('controllers: %s: expected exactly one, of type diff_controller'
                          % (', '.join(map(str, controllers.values)) or 'none'))
    name, = controllers.values
    base = controllers.section(name, CONTROLLER_KEYS)
    kind = base.get('type', expected='diff_controller')
    if kind != 'diff_controller':
        raise ConfigError('%s: %r: unknown controller type, expected one of: diff_controller'
                          % (base.path('type'), kind))
    sections = [top, base]

    joints = []
    all_joints = top.section('joints', default={})
    for joint in all_joints.values:
        if not (isinstance(joint, str) and re.match(r'^[A-Za-z]\w*$', joint)) or joint in WHEELS:
            raise ConfigError('joints: %r: expected a name of letters, digits and underscores, other than %s'
                              % (joint, ' and '.join(WHEELS)))
        section = all_joints.section(joint, JOINT_KEYS)
        joints.append(read_joint(joint, section))
        sections.append(section)

    fields = dict(
        name=str(name),
        odom_frame_id=base.frame('odom_frame_id', 'odom'),
        base_frame_id=base.frame('base_frame_id', 'base_link'),
        base_width=base.number('base_width', expected='a finite width above 0 in m'),
        wheel_radius=base.number('wheel_radius', 0.033, expected='a finite radius above 0 in m'),
        rate=base.number('rate', 50.0, high=1000.0, expected='a rate above 0 and up to 1000 in Hz'),
        timeout=round(SECOND * base.number('timeout', 1.0, high=1e6, closed=True,
                                           expected='a time from 0 (never) to 1000000 in s')),
        limits=Limits(base.number('max_linear_speed', inf, expected='a finite speed above 0 in m/s'),
                      base.number('max_angular_speed', inf, expected='a finite speed above 0 in rad/s')),
        publish_tf=publish_tf,
        joints=joints)
    if fields['odom_frame_id'] == fields['base_frame_id']:
        raise ConfigError('%s: %r: expected a frame other than odom_frame_id'
                          % (base.path('base_frame_id'), fields['base_frame_id']))
    return Config(ignored=sorted(key for s in sections for key in s.ignored()),
                  unknown=sorted(key for s in sections for key in s.unknown()), **fields)
