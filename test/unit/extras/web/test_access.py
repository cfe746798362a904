"""The hosts of requests, and the token."""
import re

import pytest

from rbx1_nav.extras.web import access
from rbx1_nav.extras.web.access import accepted_hosts, make_token, same_token


@pytest.fixture(autouse=True)
def name_this_machine(monkeypatch):
    monkeypatch.setattr(access.socket, 'gethostname', lambda: 'Desk')


@pytest.mark.parametrize('address, accepted, rejected', [
    ('localhost', ['localhost', '127.0.0.1', '[::1]'], ['desk', '10.0.0.1', '127.0.0.2', '0.0.0.0']),
    ('192.168.1.5', ['localhost', '192.168.1.5'], ['192.168.1.6', '192x168y1z5']), ('fd00::1', ['[fd00::1]'], ['fd00']),
    ('0.0.0.0', ['localhost', 'desk', 'desk.local', '192.168.1.5', '[fd00::1]'], ['other'])])
def test_hosts(address, accepted, rejected):
    pattern = accepted_hosts(address)
    for host in accepted:
        assert re.match(pattern, host), host
    for host in (*rejected, '', 'evil.example', 'localhost.evil.example', '127.0.0.1.evil.example', 'localhost@evil',
                 'localhost:x', 'localhost#', '[::1', '127.0.0.1, localhost', ' localhost'):
        assert not re.match(pattern, host), host


def test_a_token():
    token = make_token()
    assert len(token) >= 20 and make_token() != token
    assert same_token(token, token)
    for wrong in ('', token[:-1], token + 'x', token.upper() + '_', None, 5, '\ud800', 'ü'):
        assert not same_token(token, wrong)
