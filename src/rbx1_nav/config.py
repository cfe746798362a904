"""Reads configuration: mappings of keys to values, and one clear line for each value that makes no sense."""
import difflib
from math import isfinite
import re
import reprlib

import yaml

AUTO = 'auto'       # a value that is found out at run time

_short = reprlib.Repr()
_short.maxstring = _short.maxother = 200    # characters


class ConfigError(ValueError):
    """A value that makes no sense. The text names the key, the value and what is expected."""


def show(value):
    """Any value as short text of one line."""
    if isinstance(value, int) and value.bit_length() > 1000:
        return 'an integer of %d bits' % value.bit_length()
    try:
        return _short.repr(value)
    except ValueError:      # such an integer inside of it: Python does not print more than 4300 digits
        return 'a %s with huge numbers' % type(value).__name__


def show_name(name):
    """A key, a frame, a path or an argument: as it is if it is text of one line, else as show()."""
    return name if isinstance(name, str) and name.isprintable() and len(name) <= 200 else show(name)


def suggestion(name, names):
    """For an unknown name: ' (did you mean NAME?)' with the known one that is most similar, '' if none is."""
    close = difflib.get_close_matches(name, names, 1) if isinstance(name, str) else []
    return ' (did you mean %s?)' % close[0] if close else ''


def describe(value):
    """A value as it stands in the YAML file, with a hint where YAML reads a number as text."""
    try:
        is_number = isinstance(value, str) and len(value) < 100 and isfinite(float(value.replace(',', '.')))
    except ValueError:
        is_number = False
    return show(value) + (' (text to YAML: write %s)' % as_yaml_number(value.replace(',', '.')) if is_number else '')


def as_yaml_number(text):
    """The number in a text, as YAML 1.1 reads it: with a decimal point, and a sign in the exponent."""
    mantissa, _, exponent = text.strip().lower().partition('e')
    if not exponent:
        return '%s without quotes' % mantissa
    return '%s%se%s%s' % (mantissa, '' if '.' in mantissa else '.0', '' if exponent[0] in '+-' else '+', exponent)


def load_yaml(path):
    """The content of a YAML file. Raises ConfigError, which does not name the file."""
    try:
        with open(path, encoding='utf-8') as file:
            return yaml.safe_load(file)
    except Exception as error:      # pylint: disable=broad-except
        # besides its own errors, yaml raises Python's: KeyError for `!!bool x`, RecursionError for `[[[[...`
        raise ConfigError('expected a YAML file: %s' % (' '.join(str(error).split()) or type(error).__name__))


class Section:
    """One mapping of the configuration. Keeps track of the keys that were read, so that the others can be reported."""

    def __init__(self, values, key='', hardware=()):
        """values: the mapping; key: its own full name; hardware: keys that only hardware needs. Raises ConfigError."""
        self.key = key
        if not isinstance(values, dict):
            raise ConfigError('%s: %s: expected a mapping of keys to values'
                              % (key or 'configuration', show(values)))
        self.values = values
        self.hardware = set(hardware)
        self.known = set(hardware)

    def path(self, key):
        """The full name of a key, as rosparam spells it."""
        return '%s/%s' % (self.key, show_name(key)) if self.key else show_name(key)

    def get(self, key, default=None, expected='a value'):
        """The value of a key. Raises ConfigError if it is missing and has no default."""
        self.known.add(key)
        if key in self.values:
            return self.values[key]
        if default is None:
            raise ConfigError('%s: missing: expected %s' % (self.path(key), expected))
        return default

    def number(self, key, low, high, default=None, what='a number', unit=''):
        """A number from `low` to `high`; only the default may be outside. what, unit: for the text of the error."""
        expected = '%s from %.7g to %.7g%s' % (what, low, high, unit and ' in ' + unit)
        value = self.get(key, default, expected)
        # bool is a subclass of int, and a mistake here; nan fails the comparison
        if key in self.values and not (isinstance(value, (int, float)) and not isinstance(value, bool)
                                       and low <= value <= high):
            raise ConfigError('%s: %s: expected %s' % (self.path(key), describe(value), expected))
        return float(value)

    def choice(self, key, choices, default):
        """One of several values: texts, numbers, or true and false."""
        value = self.get(key, default)
        for each in choices:
            # 57600.0 is 57600, but true is not 1
            if value == each and isinstance(value, bool) == isinstance(each, bool):
                return each
        raise ConfigError('%s: %s: expected one of %s'
                          % (self.path(key), show(value), ', '.join(str(each).lower() for each in choices)))

    def flag(self, key, default):
        """True or false."""
        value = self.get(key, default)
        if not isinstance(value, bool):
            raise ConfigError('%s: %s: expected true or false' % (self.path(key), show(value)))
        return value

    def frame(self, key, default):
        """A tf2 frame name, of at most 200 characters. A leading slash, as in old files, is removed."""
        value = self.get(key, default)
        if not (isinstance(value, str) and re.fullmatch(r'/?[^/\s]+(/[^/\s]+)*', value) and value.isprintable()
                and len(value) <= 200):     # lines of the log contain it
            raise ConfigError('%s: %s: expected the name of a frame' % (self.path(key), show(value)))
        return value.lstrip('/')

    def section(self, key, hardware=(), default=None, expected='a mapping'):
        """A mapping inside this one."""
        return Section(self.get(key, default, expected), self.path(key), hardware)

    def ignored(self):
        """Full names of the keys that only hardware needs."""
        return [self.path(key) for key in self.values if key in self.hardware]

    def unknown(self):
        """Full names of the keys that were never read, each with its suggestion()."""
        return [self.path(key) + suggestion(key, self.known) for key in self.values if key not in self.known]
