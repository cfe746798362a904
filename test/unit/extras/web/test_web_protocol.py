"""What a browser sends is what the page sends, or rejected."""
import json

from hypothesis import given, strategies
import pytest

from rbx1_nav.extras.web.page_messages import (
    DriveRequest, HandRequest, Hello, InvalidMessage, InviteRequest, ResetRequest, RunRequest, StopRequest, encode,
    parse)


@pytest.mark.parametrize('fields, message', [
    ({'type': 'hello', 'token': 'abc'}, Hello('abc')),
    ({'type': 'hello'}, Hello('', '')),
    ({'type': 'hello', 'code': 'a'}, Hello('', 'a')),
    ({'type': 'invite'}, InviteRequest()),
    ({'type': 'run', 'method': 'ekf', 'reset': True}, RunRequest('ekf', True, False, 0.0)),
    ({'type': 'hand', 'on': True, 'confirmed': True, 'clock': 2.5}, HandRequest(True, True, 2.5)),
    ({'type': 'drive', 'forward': 1, 'left': -0.5}, DriveRequest(1.0, -0.5, 0.0)),
    ({'type': 'drive'}, DriveRequest(0.0, 0.0, 0.0)),
    ({'type': 'reset'}, ResetRequest(0.0)),
    ({'type': 'stop', 'more': 1}, StopRequest())])
def test_a_message(fields, message):
    assert parse(json.dumps(fields)) == message


@pytest.mark.parametrize('text', [
    b'{"type": "stop"}', '', 'stop', '[]', '"stop"', '{}', '{"type": "other"}', '{"type": 1}',
    '{"type": ["run"]}', '{"type": "hello", "token": 1}', '{"type": "run"}',
    '{"type": "run", "method": "../square"}',
    '{"type": "run", "method": "timed", "reset": 1}', '{"type": "drive", "forward": 1.001}',
    '{"type": "drive", "forward": NaN}', '{"type": "drive", "left": Infinity}', '{"type": "drive", "left": true}',
    '{"type": "drive", "left": 1' + 400 * '0' + '}', '{"type": "drive", "left": "1"}',
    '{"type": "drive", "left": null}', 900 * '[', '{"type": "stop"}' + 2000 * ' '])
def test_anything_else_is_rejected(text):
    with pytest.raises(InvalidMessage):
        parse(text)


@given(strategies.text() | strategies.recursive(
    strategies.none() | strategies.booleans() | strategies.floats() | strategies.integers() | strategies.text(),
    lambda inner: strategies.lists(inner) | strategies.dictionaries(
        strategies.sampled_from(['type', 'forward', 'left', 'method', 'on']), inner)).map(json.dumps))
def test_no_other_error(text):
    try:
        parse(text)
    except InvalidMessage:
        pass


def test_what_is_sent_is_json():
    assert json.loads(encode('refused', reason='"ü"')) == {'type': 'refused', 'reason': '"ü"'}
    with pytest.raises(ValueError):
        encode('frame', time=float('nan'))
