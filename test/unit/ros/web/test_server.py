"""The HTTP server: the files of the page, and nothing else; Host and Origin; limits."""
import asyncio
import os
import socket
import time

import pytest
from tornado.httpclient import HTTPClientError, HTTPRequest
from tornado.websocket import websocket_connect

from rbx1_nav.ros.web.checks import HostCheck
from rbx1_nav.ros.web.server import MAX_CONNECTIONS, PageServer, read_files

FOLDER = os.path.join(os.path.dirname(__file__), '..', '..', '..', '..', 'web')
LIMIT = 60      # s, after which a wait fails


class Connections:
    """Takes the place of Connections: keeps what arrives."""
    full = False

    def __init__(self):
        self.browsers, self.messages = {}, []

    def opened(self, browser):
        self.browsers[browser] = True

    def closed(self, browser):
        self.browsers.pop(browser, None)

    def received(self, browser, text):
        self.messages.append(text)
        browser.write_message('echo')

    def send_frames(self):
        pass


@pytest.fixture(name='server')
def start():
    server = PageServer(FOLDER, HostCheck('localhost'), {'/socket': Connections()}, 'localhost', 0)
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
    files = read_files(FOLDER)
    assert {'/', '/index.html', '/main.js', '/style.css'} <= set(files)
    for path, (kind, content) in files.items():
        head, _, body = get(server, path).partition('\r\n\r\n')
        assert status(head) == 200 and f'Content-Type: {kind}' in head and len(body) == len(content)
        assert "default-src 'none'" in head and 'X-Frame-Options: DENY' in head and '\r\nServer:' not in head


def test_the_page_needs_nothing_of_other_hosts():
    for path, (_, content) in read_files(FOLDER).items():
        text = content.decode().replace('http://www.w3.org/', '')      # names, not addresses
        assert '://' not in text.replace('`${protocol}://${location.host}${this.path}`', ''), path


@pytest.mark.parametrize('path', ['/../setup.py', '/..%2fsetup.py', '//etc/passwd', '/web', '/.', '/socket/', '/A.js'])
def test_nothing_else_is_served(server, path):
    assert status(get(server, path)) == 404


@pytest.mark.parametrize('path', ['/', '/main.js', '/socket', '/other'])
@pytest.mark.parametrize('headers', [{'Host': 'evil.example'}, {'Origin': 'http://evil.example'}, {'Origin': 'null'}])
def test_foreign_requests_are_refused(server, path, headers):
    assert status(get(server, path, **headers)) == 403


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
    end = time.monotonic() + LIMIT
    while list(server.connections)[0].browsers:
        assert time.monotonic() < end


def test_no_socket_when_there_are_too_many(server):
    list(server.connections)[0].full = True

    async def talk():
        with pytest.raises(HTTPClientError, match='503'):
            await connect(server)
    asyncio.run(talk())


def test_a_new_connection_replaces_the_oldest(server):
    slow = [socket.create_connection(('127.0.0.1', server.port)) for _ in range(MAX_CONNECTIONS + 1)]
    try:
        assert status(get(server)) == 200
        slow[0].settimeout(LIMIT)
        assert slow[0].recv(1) == b''
        slow[-1].settimeout(0.05)
        with pytest.raises(socket.timeout):
            slow[-1].recv(1)
    finally:
        for each in slow:
            each.close()
