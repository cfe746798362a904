"""The messages between page and server. Each is one JSON object; docs/web_view.md lists them.

Every field that a browser sends is checked here. The rest of the server uses the classes below.
"""
from __future__ import annotations

import json
from typing import Mapping, NamedTuple, Union

MAX_MESSAGE = 1024      # bytes
MAX_NUMBER = 2 ** 53     # largest integer that JavaScript represents exactly
METHODS = ('timed', 'odometry', 'gyro')


class InvalidMessage(ValueError):
    """A message that the page never sends. The text names the error."""


class Hello(NamedTuple):
    """The first message of a browser."""

    token: str      # '' for a browser that can only watch


class Run(NamedTuple):
    """Start a run."""

    method: str         # one of METHODS
    reset: bool         # whether to reset a simulated robot before the run
    confirmed: bool     # whether the user has confirmed that a real robot may move
    clock: float        # s: `clock` of the last frame that the browser has received


class Hand(NamedTuple):
    """Switch driving by hand on or off."""

    on: bool
    confirmed: bool     # as in Run
    clock: float        # s, as in Run


class Drive(NamedTuple):
    """The keys that are held."""

    forward: float      # -1 to 1, fraction of the linear speed
    left: float         # -1 to 1, fraction of the angular speed
    clock: float        # s, as in Run


class Reset(NamedTuple):
    """Put a simulated robot back at its start."""

    clock: float        # s, as in Run


class Stop(NamedTuple):
    """Stop the robot, regardless of which node drives it."""

    number: int = 0     # returned in the answer


Message = Union[Hello, Run, Hand, Drive, Reset, Stop]


def parse(text: object) -> Message:
    """Parse a message from a browser. Raises InvalidMessage."""
    if not isinstance(text, str) or len(text) > MAX_MESSAGE:
        raise InvalidMessage('expected text of at most 1 KB')
    try:
        fields = json.loads(text)
    except (ValueError, RecursionError):
        raise InvalidMessage('expected JSON') from None
    kind = fields.get('type') if isinstance(fields, dict) else None
    if kind == 'hello':
        return Hello(_text(fields, 'token'))
    if kind == 'run':
        method = _text(fields, 'method')
        if method not in METHODS:
            raise InvalidMessage(f'method: expected one of {", ".join(METHODS)}')
        return Run(method, _flag(fields, 'reset'), _flag(fields, 'confirmed'), _clock(fields))
    if kind == 'hand':
        return Hand(_flag(fields, 'on'), _flag(fields, 'confirmed'), _clock(fields))
    if kind == 'drive':
        return Drive(_fraction(fields, 'forward'), _fraction(fields, 'left'), _clock(fields))
    if kind == 'reset':
        return Reset(_clock(fields))
    if kind == 'stop':
        return Stop(int(_number(fields, 'number', 0, MAX_NUMBER)))
    raise InvalidMessage('type: expected hello, run, hand, drive, reset or stop')


def _text(fields: Mapping[str, object], name: str) -> str:
    value = fields.get(name, '')
    if not isinstance(value, str):
        raise InvalidMessage(f'{name}: expected text')
    return value


def _flag(fields: Mapping[str, object], name: str) -> bool:
    value = fields.get(name, False)
    if not isinstance(value, bool):
        raise InvalidMessage(f'{name}: expected true or false')
    return value


def _number(fields: Mapping[str, object], name: str, low: float, high: float) -> float:
    value = fields.get(name, 0)
    # bool is a subclass of int; a very large integer can be compared, but not converted to float; NaN is in no range
    if isinstance(value, bool) or not isinstance(value, (int, float)) or not low <= value <= high:
        raise InvalidMessage(f'{name}: expected a number from {low} to {high}')
    return float(value)


def _fraction(fields: Mapping[str, object], name: str) -> float:
    return _number(fields, name, -1, 1)


def _clock(fields: Mapping[str, object]) -> float:
    return _number(fields, 'clock', 0, MAX_NUMBER)


def encode(kind: str, **fields: object) -> bytes:
    """Encode a message to a browser. Raises ValueError for NaN and infinity, which JSON does not support."""
    return json.dumps({'type': kind, **fields}, separators=(',', ':'), allow_nan=False).encode()
