"""An HTTP and WebSocket client that can also send invalid requests and frames."""
import base64
import json
import os
import socket
import struct
import time

TEXT, CLOSE = 1, 8      # opcodes, RFC 6455
LIMIT = 60      # s


def request(port, path='/', host=None, method='GET', **headers):
    """Return the status of a request, or None if the server closed the connection without a reply."""
    lines = ''.join(f'{name}: {value}\r\n' for name, value in headers.items())
    with socket.create_connection(('127.0.0.1', port), 10) as connection:
        try:
            connection.sendall(f'{method} {path} HTTP/1.1\r\nHost: {host or f"localhost:{port}"}\r\n'
                               f'Connection: close\r\n{lines}\r\n'.encode())
            line = connection.recv(1000)
        except OSError:
            return None
    return int(line.split()[1]) if line else None


class WebClient:
    """A WebSocket to the view."""

    def __init__(self, port, token=None, small=False, code='', **headers):
        """token, code: sent with hello, unless the token is None; small: whether to use a small receive buffer. Raises
        ConnectionError with the HTTP status if the server rejects the request."""
        self.socket = socket.socket()
        if small:
            self.socket.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 2048)
        self.socket.settimeout(10)
        self.socket.connect(('127.0.0.1', port))
        key = base64.b64encode(os.urandom(16)).decode()
        headers = {'Host': f'localhost:{port}', 'Upgrade': 'websocket', 'Connection': 'Upgrade',
                   'Sec-WebSocket-Version': '13', 'Sec-WebSocket-Key': key, **headers}
        self.socket.sendall(('GET /socket HTTP/1.1\r\n' + ''.join(
            f'{name}: {value}\r\n' for name, value in headers.items()) + '\r\n').encode())
        self.received = b''
        while b'\r\n\r\n' not in self.received:
            self.receive()
        head, self.received = self.received.split(b'\r\n\r\n', 1)
        if b' 101 ' not in head.split(b'\r\n')[0]:
            self.close()
            raise ConnectionError(head.split()[1].decode())
        if token is not None:
            self.send(type='hello', token=token, code=code)

    def receive(self):
        """Wait for data. Raises ConnectionError if the connection is closed."""
        data = self.socket.recv(65536)
        if not data:
            raise ConnectionError('closed')
        self.received += data

    def send(self, **fields):
        """Send a message. A page sends the clock of the last frame; this is the clock of the node."""
        self.send_frame(json.dumps({'clock': time.monotonic(), **fields}).encode())

    def send_frame(self, data, opcode=TEXT):
        """Send a frame. Frames from a client must be masked; the mask is zero."""
        size = bytes([0x80 | len(data)]) if len(data) < 126 else bytes([0x80 | 126]) + struct.pack('!H', len(data))
        self.socket.sendall(bytes([0x80 | opcode]) + size + 4 * b'\0' + data)

    def next(self):
        """Return the next message. Raises ConnectionError with the reason if the server closes, or TimeoutError."""
        while True:
            opcode, data = self.next_frame()
            if opcode == TEXT:
                return json.loads(data)
            if opcode == CLOSE:
                raise ConnectionError(data[2:].decode() or 'closed')

    def next_frame(self):
        """Return (opcode, data) of the next frame."""
        while True:
            if len(self.received) >= 2:
                size, start = self.received[1] & 127, 2
                if size >= 126:
                    start += 2 if size == 126 else 8
                    size = int.from_bytes(self.received[2:start], 'big')
                if len(self.received) >= start + size:
                    opcode, data = self.received[0] & 15, self.received[start:start + size]
                    self.received = self.received[start + size:]
                    return opcode, data
            self.receive()

    def wait_for(self, kind):
        """Return the next message of a kind; skip all others. Raises TimeoutError."""
        end = time.monotonic() + LIMIT
        while time.monotonic() < end:
            message = self.next()
            if message['type'] == kind:
                return message
        raise TimeoutError(f'no {kind} within {LIMIT} s')

    def close(self):
        """Close the connection without a close frame."""
        self.socket.close()
