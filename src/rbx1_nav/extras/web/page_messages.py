"""The messages between page and server. Each is one JSON object; docs/web_view.md lists them.

Every field that a browser sends is checked here. The rest of the server uses the classes below.
"""
from __future__ import annotations

import json
from typing import Any, NamedTuple, Union

from rbx1_nav.exercise.methods import METHODS

MAX_MESSAGE = 1024      # bytes
MAX_NUMBER = 2 ** 53     # largest integer that JavaScript represents exactly


class InvalidMessage(ValueError):
    """A message that the page never sends. The text names the error."""


class Hello(NamedTuple):
    """The first message of a browser."""

    token: str = ''     # '' for a browser that has none
    code: str = ''      # of a printed address, to be exchanged for the token


class RunRequest(NamedTuple):
    """Start a run."""

    method: str = ''            # a key of METHODS
    reset: bool = False         # whether to reset a simulated robot before the run
    confirmed: bool = False     # whether the user has confirmed that a real robot may move
    clock: float = 0.0          # s: `clock` of the last frame that the browser has received


class HandRequest(NamedTuple):
    """Switch driving by hand on or off."""

    on: bool = False
    confirmed: bool = False     # as in RunRequest
    clock: float = 0.0          # s, as in RunRequest


class DriveRequest(NamedTuple):
    """The keys that are held."""

    forward: float = 0.0    # -1 to 1, fraction of the linear speed
    left: float = 0.0       # -1 to 1, fraction of the angular speed
    clock: float = 0.0      # s, as in RunRequest


class ResetRequest(NamedTuple):
    """Put a simulated robot back at its start."""

    clock: float = 0.0      # s, as in RunRequest


class ChooseRequest(NamedTuple):
    """Choose the floor, its seed, the distance or the speed of a simulated robot."""

    name: str = ''      # see choices.py
    value: str = ''
    clock: float = 0.0  # s, as in RunRequest


class InviteRequest(NamedTuple):
    """Make an address for another browser."""


class StopRequest(NamedTuple):
    """Stop the robot, regardless of which node drives it."""

    number: int = 0     # returned in the answer


Request = Union[RunRequest, HandRequest, DriveRequest, ResetRequest, ChooseRequest, StopRequest]
KINDS: dict[str, type[Union[Hello, Request, InviteRequest]]] = {
    'hello': Hello, 'run': RunRequest, 'hand': HandRequest, 'drive': DriveRequest, 'reset': ResetRequest,
    'choose': ChooseRequest, 'invite': InviteRequest, 'stop': StopRequest}
RANGES = {'forward': (-1, 1), 'left': (-1, 1), 'clock': (0, MAX_NUMBER), 'number': (0, MAX_NUMBER)}


def parse(text: object) -> Hello | Request | InviteRequest:
    """Parse a message from a browser. Raises InvalidMessage."""
    if not isinstance(text, str) or len(text) > MAX_MESSAGE:
        raise InvalidMessage('expected text of at most 1 KB')
    try:
        fields = json.loads(text)
    except (ValueError, RecursionError):
        raise InvalidMessage('expected JSON') from None
    kind = fields.get('type') if isinstance(fields, dict) else None
    if not isinstance(kind, str) or kind not in KINDS:
        raise InvalidMessage(f"type: expected one of {', '.join(KINDS)}")
    defaults = KINDS[kind]()
    return defaults._replace(**{name: _checked(name, fields.get(name, default), default)
                                for name, default in defaults._asdict().items()})


# Any: the result has the type of the default
def _checked(name: str, value: object, default: Any) -> Any:
    """Return the value of a field. Raises InvalidMessage."""
    if name == 'method':
        if value not in METHODS:
            raise InvalidMessage(f'method: expected one of {", ".join(METHODS)}')
    elif name not in RANGES:
        if not isinstance(value, type(default)):
            raise InvalidMessage(f"{name}: expected {'text' if default == '' else 'true or false'}")
    else:
        low, high = RANGES[name]
        # bool is a subclass of int; a very large integer can be compared, but not converted; NaN is in no range
        if isinstance(value, bool) or not isinstance(value, (int, float)) or not low <= value <= high:
            raise InvalidMessage(f'{name}: expected a number from {low} to {high}')
        if isinstance(default, int) and value != int(value):
            raise InvalidMessage(f'{name}: expected an integer')
        return type(default)(value)
    return value


def kind_of(message: Request) -> str:
    return next(kind for kind, each in KINDS.items() if isinstance(message, each))


def encode(kind: str, **fields: object) -> bytes:
    """Encode a message to a browser. Raises ValueError for NaN and infinity, which JSON does not support."""
    return json.dumps({'type': kind, **fields}, separators=(',', ':'), allow_nan=False).encode()
