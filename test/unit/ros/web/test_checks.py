"""Host and Origin, token, and rate."""
import pytest

from rbx1_nav.config import ConfigError
from rbx1_nav.ros.web.checks import HostCheck, RateLimit, check_address, check_port, make_token, same_token

LOCAL = HostCheck('localhost', {'desk'})
EVERYWHERE = HostCheck('0.0.0.0', {'desk', 'desk.local'})


@pytest.mark.parametrize('host', ['localhost', 'localhost:8080', 'LOCALHOST:1', '127.0.0.1:9', '[::1]:8080', '[::1]'])
def test_the_loopback_is_accepted_with_any_port(host):
    # a forwarded port is another one at the browser's end
    assert LOCAL.accepts(host, None) and EVERYWHERE.accepts(host, None)
    assert LOCAL.accepts(host, f'http://{host}') and LOCAL.accepts(host, f'https://{host}')


@pytest.mark.parametrize('host', [
    None, '', 'evil.example', 'evil.example:8080', 'localhost.evil.example', '127.0.0.1.evil.example', 'desk',
    '10.0.0.1', 'localhost@evil.example', 'evil.example/localhost', 'localhost:x',
    'localhost:99999999', 'localhost#', 'localhost?',
    ' localhost', '[::1', '127.0.0.1, localhost', 'localhost\t', 'local host', '0.0.0.0', '127.0.0.2'])
def test_other_hosts_are_refused(host):
    assert not LOCAL.accepts(host, None)


@pytest.mark.parametrize('origin', ['http://evil.example', 'null', '', 'http://localhost:1', 'http://localhost',
                                    'http://localhost:8080.evil.example', 'file://', 'ftp://localhost:8080'])
def test_other_origins_are_refused(origin):
    assert not LOCAL.accepts('localhost:8080', origin)


def test_all_addresses_of_the_machine():
    for host in ('desk:8080', 'desk.local', '192.168.1.5:8080', '[fd00::1]:8080'):
        assert EVERYWHERE.accepts(host, f'http://{host}')
    # a name of which this machine knows nothing may have been rebound to its address
    assert not EVERYWHERE.accepts('evil.example', None)


def test_a_token():
    token = make_token()
    assert len(token) >= 20 and make_token() != token
    assert same_token(token, token)
    for wrong in ('', token[:-1], token + 'x', token.upper() + '_', None, 5, '\ud800', 'ü'):
        assert not same_token(token, wrong)


def test_a_rate():
    limit = RateLimit(10, 3)
    assert [limit.allows(0.0) for _ in range(4)] == [True, True, True, False]
    assert limit.allows(0.1) and not limit.allows(0.1)
    assert [limit.allows(100.0) for _ in range(4)] == [True, True, True, False]


def test_an_address():
    assert [check_address(each) for each in ('localhost', '0.0.0.0', '::', 'Desk.local')] == [
        'localhost', '0.0.0.0', '::', 'desk.local']
    for wrong in ('', ' ', '1.2.3', '256.0.0.1', 'a b', 'http://localhost', 5, None, '-a'):
        with pytest.raises(ConfigError, match='address: .*: expected'):
            check_address(wrong)


def test_a_port():
    assert check_port(8080) == 8080 and check_port(0) == 0
    for wrong in (80, 65536, -1, True, '8080', 8080.0):
        with pytest.raises(ConfigError, match='port: .*: expected a TCP port'):
            check_port(wrong)
