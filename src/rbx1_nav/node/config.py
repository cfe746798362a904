"""Reads configuration mappings, and reports each invalid value in one clear line."""
from __future__ import annotations

from datetime import date
import difflib
from os.path import commonprefix
import re
import reprlib
from typing import Iterable, Mapping, Sequence, TypeVar, Union

AUTO = 'auto'       # a value that is determined at run time
SHORT = 4           # letters of the longest name that counts as short
NUMBER = re.compile(r'\s*[-+]?(\d+\.?\d*|\.\d+)(e[-+]?\d+)?\s*', re.IGNORECASE)

# content of a YAML file or the parameter server; a key that is not text is a mistake, and is shown like any other key
YamlValue = Union[None, bool, int, float, str, bytes, date, Sequence['YamlValue'], Mapping[str, 'YamlValue']]
Scalar = Union[bool, int, float, str]
Choice = TypeVar('Choice', bound=Scalar)

_short = reprlib.Repr()
_short.maxstring = _short.maxother = 200    # characters


class ConfigError(ValueError):
    """Raised for an invalid value.

    The text names the key, the value and what is expected.
    """


def show(value: YamlValue) -> str:
    """Return any value as short text on one line."""
    return _short.repr(value)


def show_name(name: YamlValue) -> str:
    """Return a key, a frame, a path or an argument unchanged if it is text on one line, else as show() does."""
    return name if isinstance(name, str) and name.isprintable() and len(name) <= 200 else show(name)


def suggestion(name: YamlValue, names: Iterable[str]) -> str:
    """Return ' (did you mean NAME?)' with the known name that is most similar to an unknown one, or '' if none is."""
    close = close_match(name, names) if isinstance(name, str) else ''
    return close and f' (did you mean {close}?)'


def close_match(name: str, names: Iterable[str], cutoff: float = 0.6) -> str:
    """Return the known name that is most similar to an unknown one, or '' if none is.

    cutoff: least ratio of difflib. Two short names must also differ by a single slip, because their ratio is high by
    chance: `imu` and `sim` have a ratio of 0.67.
    """
    names = [each for each in names if max(len(name), len(each)) > SHORT or _is_slip(name, each)]
    return ''.join(difflib.get_close_matches(name, names, 1, cutoff))


def _is_slip(name: str, known: str) -> bool:
    """Return whether one letter is missing, added or replaced, or two neighbors are swapped."""
    start = len(commonprefix([name, known]))
    name, known = name[start:][::-1], known[start:][::-1]
    end = len(commonprefix([name, known]))
    name, known = name[end:], known[end:]
    return max(len(name), len(known)) <= 1 or (len(name) == 2 and name == known[::-1])


def describe(value: YamlValue) -> str:
    """Return a value as written in the YAML file, with a hint where YAML reads a number as text."""
    text = value.replace(',', '.') if isinstance(value, str) and len(value) < 100 else ''
    hint = f' (text to YAML: write {as_yaml_number(text)})' if NUMBER.fullmatch(text) else ''
    return show(value) + hint


def as_yaml_number(text: str) -> str:
    """Return the number in a text as YAML 1.1 requires it, with a decimal point and a sign in the exponent."""
    mantissa, _, exponent = text.strip().lower().partition('e')
    if not exponent:
        return f'{mantissa} without quotes'
    point = '' if '.' in mantissa else '.0'
    sign = '' if exponent[0] in '+-' else '+'
    return f'{mantissa}{point}e{sign}{exponent}'


def load_yaml(path: str) -> YamlValue:
    """Return the content of a YAML file. Raises ConfigError, which does not name the file."""
    import yaml     # here, because the page without ROS has neither YAML files nor this module
    try:
        with open(path, encoding='utf-8') as file:
            content: YamlValue = yaml.safe_load(file)
            return content
    except Exception as error:
        # yaml raises its own errors, and also Python's: KeyError for `!!bool x`, RecursionError for `[[[[...`
        raise ConfigError(f"expected a YAML file: {' '.join(str(error).split()) or type(error).__name__}") from error


class Section:
    """One mapping of the configuration, which tracks the keys that were read so that the others can be reported."""

    def __init__(self, values: YamlValue, key: str = '', hardware: Iterable[str] = ()) -> None:
        """values: the mapping; key: its full name; hardware: keys that only hardware needs. Raises ConfigError."""
        self.key = key
        if not isinstance(values, dict):
            raise ConfigError(f"{key or 'configuration'}: {show(values)}: expected a mapping of keys to values")
        self.values: Mapping[str, YamlValue] = values
        self.hardware = set(hardware)
        self.known = set(hardware)

    def path(self, key: str) -> str:
        """Return the full name of a key, as rosparam spells it."""
        return f'{self.key}/{show_name(key)}' if self.key else show_name(key)

    def get(self, key: str, default: YamlValue = None, expected: str = 'a value') -> YamlValue:
        """Return the value of a key. Raises ConfigError if it is missing and has no default."""
        self.known.add(key)
        if key in self.values:
            return self.values[key]
        if default is None:
            raise ConfigError(f'{self.path(key)}: missing: expected {expected}')
        return default

    def number(self, key: str, low: float, high: float, default: float | None = None, what: str = 'a number',
               unit: str = '') -> float:
        """Return a number from `low` to `high`; only the default may be outside this range. Raises ConfigError.

        what, unit: for the error message.
        """
        expected = f'{what} from {low:.7g} to {high:.7g}' + (f' in {unit}' if unit else '')
        value = self.get(key, default, expected)
        # bool is a subclass of int, but a mistake here; nan fails the comparison
        if (isinstance(value, (int, float)) and not isinstance(value, bool)
                and (low <= value <= high or key not in self.values)):
            return float(value)
        raise ConfigError(f'{self.path(key)}: {describe(value)}: expected {expected}')

    def choice(self, key: str, choices: Sequence[Choice], default: Choice | None) -> Choice:
        """Return one of several values: texts, numbers, or true and false. Raises ConfigError."""
        value = self.get(key, default)
        for each in choices:
            # 57600.0 is 57600, but true is not 1
            if value == each and isinstance(value, bool) == isinstance(each, bool):
                return each
        names = ', '.join(str(each).lower() for each in choices)
        raise ConfigError(f'{self.path(key)}: {show(value)}: expected one of {names}')

    def flag(self, key: str, default: bool) -> bool:
        """Return true or false. Raises ConfigError."""
        value = self.get(key, default)
        if not isinstance(value, bool):
            raise ConfigError(f'{self.path(key)}: {show(value)}: expected true or false')
        return value

    def frame(self, key: str, default: str) -> str:
        """Return a tf2 frame name of at most 200 characters. Raises ConfigError.

        A leading slash, as in old files, is removed.
        """
        value = self.get(key, default)
        if not (isinstance(value, str) and re.fullmatch(r'/?[^/\s]+(/[^/\s]+)*', value) and value.isprintable()
                and len(value) <= 200):     # log lines contain it
            raise ConfigError(f'{self.path(key)}: {show(value)}: expected the name of a frame')
        return value.lstrip('/')

    def section(self, key: str, hardware: Iterable[str] = (), default: YamlValue = None,
                expected: str = 'a mapping') -> Section:
        """Return a mapping inside this one. Raises ConfigError."""
        return Section(self.get(key, default, expected), self.path(key), hardware)

    def ignored(self) -> list[str]:
        """Return the full names of the keys that only hardware needs."""
        return [self.path(key) for key in self.values if key in self.hardware]

    def unknown(self) -> list[str]:
        """Return the full names of the keys that were never read, each with its suggestion()."""
        return [self.path(key) + suggestion(key, self.known) for key in self.values if key not in self.known]
