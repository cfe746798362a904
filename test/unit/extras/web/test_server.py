"""The HTTP server: the files of the page, and nothing else; Host and Origin."""
import asyncio
import os
import re
import socket

import pytest
from tornado.httpclient import HTTPClientError, HTTPRequest
from tornado.websocket import websocket_connect

from rbx1_nav.extras.web.server import PageServer
from waiting import wait_for

FOLDER = os.path.join(os.path.dirname(__file__), '..', '..', '..', '..', 'web')
LIMIT = 60      # s, after which a wait fails


class Connections:
    """Takes the place of Connections: keeps what arrives."""
    def __init__(self):
        self.browsers, self.messages, self.flooding = {}, [], []

    def opened(self, browser):
        self.browsers[browser] = True

    def closed(self, browser):
        self.browsers.pop(browser, None)

    def received(self, browser, text):
        self.messages.append(text)
        browser.write_message('echo')

    def flooded(self, browser):
        self.flooding.append(browser)

    def send_frames(self):
        pass


@pytest.fixture(name='server')
def start():
    server = PageServer(FOLDER, {'/socket': Connections()}, 'localhost', 0, seat_ports=[8081, 8082], teacher_port=8080)
    server.start()
    yield server
    server.stop()
    assert not server.thread.is_alive()


def exchange(server, data, limit=LIMIT):
    """Send bytes, and return everything that comes back until the server closes."""
    with socket.create_connection(('127.0.0.1', server.port), timeout=limit) as connection:
        connection.sendall(data)
        received = b''
        while True:
            chunk = connection.recv(65536)
            if not chunk:
                return received.decode('latin-1')
            received += chunk


def get(server, path='/', method='GET', **headers):
    """The answer to a request, as text."""
    lines = {'Host': f'localhost:{server.port}', 'Connection': 'close', **headers}
    text = ''.join(f'{name}: {value}\r\n' for name, value in lines.items())
    return exchange(server, f'{method} {path} HTTP/1.1\r\n{text}\r\n'.encode())


def status(answer):
    return int(answer.split()[1]) if answer else None


def test_each_file_is_served_with_its_type_and_the_headers(server):
    for path in '/', '/main.js', '/style.css':
        head, _, body = get(server, path).partition('\r\n\r\n')
        kind = {'/': 'html', '/main.js': 'javascript', '/style.css': 'css'}[path]
        assert status(head) == 200 and re.search(f'Content-Type: (text|application)/{kind}', head)
        with open(os.path.join(FOLDER, path[1:] or 'index.html'), 'rb') as file:
            assert body.encode('latin-1') == file.read()
        assert "default-src 'none'" in head and 'X-Frame-Options: DENY' in head


def test_the_page_needs_nothing_of_other_hosts():
    for name in os.listdir(FOLDER):
        with open(os.path.join(FOLDER, name), encoding='utf-8') as file:
            text = file.read().replace('http://www.w3.org/', '')      # names, not addresses
        assert '://' not in text.replace('`${protocol}://${this.host}${this.path}`', ''), name


@pytest.mark.parametrize('path', ['/../setup.py', '/..%2fsetup.py', '//etc/passwd', '/web', '/socket/', '/A.js'])
def test_nothing_else_is_served(server, path):
    assert status(get(server, path)) in (403, 404)


@pytest.mark.parametrize('path', ['/', '/main.js', '/socket', '/other'])
def test_a_foreign_host_is_refused(server, path):
    assert status(get(server, path, Host='evil.example')) == 404


@pytest.mark.parametrize('origin', [
    'http://evil.example', 'null', '', 'http://localhost:1', 'http://localhost', 'http://evil.example:8080',
    'http://127.0.0.1:8080', 'https://localhost:8080', 'http://localhost:80801'])
def test_a_foreign_origin_is_refused(server, origin):
    async def talk():
        with pytest.raises(HTTPClientError, match='403'):
            await connect(server, Origin=origin)
    asyncio.run(talk())


def test_the_page_of_the_teacher_may_connect(server):
    async def talk():
        (await connect(server, Origin='http://localhost:8080')).close()
    asyncio.run(talk())


def test_the_page_may_connect_to_its_own_server_and_to_the_seats_only(server):
    policy, = re.findall('Content-Security-Policy: (.*)', get(server))
    assert policy.strip().endswith("; connect-src 'self' ws://localhost:8081 ws://localhost:8082")


def connect(server, **headers):
    """A WebSocket to the server."""
    return websocket_connect(HTTPRequest(f'ws://localhost:{server.port}/socket', headers=headers))


def test_a_socket(server):
    async def talk():
        connection = await connect(server, Origin=f'http://localhost:{server.port}')
        await connection.write_message('text')
        assert await connection.read_message() == 'echo'
        connection.close()
    asyncio.run(talk())
    assert list(server.connections)[0].messages == ['text']
    wait_for(lambda: not list(server.connections)[0].browsers)


@pytest.mark.parametrize('frame', ['text', 'ping', 'pong', 'continuation'])
def test_a_client_that_floods_is_disconnected(server, frame):
    header = {'text': b'\x81\x80', 'ping': b'\x89\x80', 'pong': b'\x8a\x80', 'continuation': b'\0\x80'}[frame]
    first = b'\x01\x80' + 4 * b'\0' if frame == 'continuation' else b''      # a message of many parts
    connections = list(server.connections)[0]
    request = (f'GET /socket HTTP/1.1\r\nHost: localhost:{server.port}\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n'
               'Sec-WebSocket-Key: AAAAAAAAAAAAAAAAAAAAAA==\r\nSec-WebSocket-Version: 13\r\n\r\n').encode()
    with socket.create_connection(('127.0.0.1', server.port), timeout=LIMIT) as flood:
        flood.sendall(request + first)
        with pytest.raises(OSError):
            for _ in range(20000):
                flood.sendall(100 * (header + 4 * b'\0'))
    wait_for(lambda: not connections.browsers)
    assert len(connections.flooding) == 1 and len(connections.messages) < 1000


def test_a_page_that_sends_as_fast_as_a_user_can_is_not_a_flood(server):
    async def talk():
        connection = await connect(server)
        for _ in range(50):
            await connection.write_message('text')
            assert await connection.read_message() == 'echo'
        connection.close()
    asyncio.run(talk())
    assert not list(server.connections)[0].flooding


def test_an_error_does_not_end_the_frames():
    connections, calls = Connections(), []

    def send_frames():
        calls.append(len(calls))
        raise ValueError('expected: it is logged')
    connections.send_frames = send_frames
    server = PageServer(FOLDER, {'/socket': connections}, 'localhost', 0)
    server.start()
    try:
        wait_for(lambda: len(calls) > 2)
    finally:
        server.stop()
