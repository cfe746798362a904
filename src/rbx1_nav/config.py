"""Reads configuration: mappings of keys to values, and one clear line for each value that makes no sense."""
from math import inf, isfinite
import re
import reprlib


class ConfigError(ValueError):
    """A value that makes no sense. The text names the key, the value and what is expected."""


def describe(value):
    """A value as it stands in the YAML file, with a hint where YAML reads a number as text."""
    try:
        is_number = isinstance(value, str) and isfinite(float(value))
    except ValueError:
        is_number = False
    return repr(value) + (' (text to YAML: write %s)' % as_yaml_number(value) if is_number else '')


def as_yaml_number(text):
    """The number in a text, as YAML 1.1 reads it: with a decimal point, and a sign in the exponent."""
    mantissa, _, exponent = text.strip().lower().partition('e')
    if not exponent:
        return '%s without quotes' % mantissa
    return '%s%se%s%s' % (mantissa, '' if '.' in mantissa else '.0', '' if exponent[0] in '+-' else '+', exponent)


def positive(key, value, expected='a finite number above 0'):
    """The value of a key as a float. Raises ConfigError if it is not a number above 0."""
    return Section({key: value}).number(key, expected=expected)


class Section:
    """One mapping of the configuration. Keeps track of the keys that were read, so that the others can be reported."""

    def __init__(self, values, key='', hardware=()):
        """values: the mapping; key: its own full name; hardware: keys that only hardware needs. Raises ConfigError."""
        self.key = key
        if not isinstance(values, dict):
            raise ConfigError('%s: %s: expected a mapping of keys to values'
                              % (key or 'configuration', reprlib.repr(values)))
        self.values = values
        self.hardware = set(hardware)
        self.known = set(hardware)

    def path(self, key):
        """The full name of a key, as rosparam spells it."""
        return '%s/%s' % (self.key, key) if self.key else key

    def get(self, key, default=None, expected='a value'):
        """The value of a key. Raises ConfigError if it is missing and has no default."""
        self.known.add(key)
        if key in self.values:
            return self.values[key]
        if default is None:
            raise ConfigError('%s: missing: expected %s' % (self.path(key), expected))
        return default

    def number(self, key, default=None, low=0.0, high=inf, expected='a finite number above 0', closed=False):
        """A finite number above `low` (or equal to it if `closed`) and at most `high`."""
        value = self.get(key, default, expected)
        # bool is a subclass of int, and a mistake here; only the default may be infinite
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
        """A tf2 frame name. A leading slash, as in old files, is removed."""
        value = self.get(key, default)
        if not isinstance(value, str) or not re.match(r'^/?[^/\s]+(/[^/\s]+)*$', value):
            raise ConfigError('%s: %r: expected the name of a frame' % (self.path(key), value))
        return value.lstrip('/')

    def section(self, key, hardware=(), default=None, expected='a mapping'):
        """A mapping inside this one."""
        return Section(self.get(key, default, expected), self.path(key), hardware)

    def ignored(self):
        """Full names of the keys that only hardware needs."""
        return [self.path(key) for key in self.values if key in self.hardware]

    def unknown(self):
        """Full names of the keys that were never read."""
        return [self.path(str(key)) for key in self.values if key not in self.known]
