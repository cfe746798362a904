"""The state of a TCP connection that the kernel reports, over the loopback interface."""
import socket
import time

import pytest

from rbx1_nav.ros.network.tcp import CLOSED_WINDOW, AcknowledgementTimer, Connection, read_connection


@pytest.fixture(name='pair')
def connect():
    """Return two connected sockets; the second one has a small receive buffer."""
    with socket.socket() as server:
        server.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 4096)
        server.bind(('127.0.0.1', 0))
        server.listen()
        with socket.create_connection(server.getsockname()) as sender:
            receiver, _ = server.accept()
            with receiver:
                yield sender, receiver


def wait_for(condition):
    for _ in range(1000):
        if condition():
            return
        time.sleep(0.01)
    raise AssertionError('timed out')


def test_a_peer_that_does_not_read_closes_its_window(pair):
    sender, _ = pair
    sender.setblocking(False)

    def fill():
        try:
            sender.send(b'x' * 1000)
        except BlockingIOError:
            pass
        return read_connection(sender).window < CLOSED_WINDOW
    wait_for(fill)
    assert read_connection(sender).unacknowledged > 0


def test_silence_begins_when_something_is_to_be_acknowledged_and_ends_with_an_acknowledgement():
    timer = AcknowledgementTimer()
    for now, unacknowledged, acknowledged, silence in ((10, 0, 100, 0), (11, 52, 100, 0), (11.5, 104, 100, 0.5),
                                                       (13, 104, 100, 2), (14, 52, 152, 0), (15, 52, 152, 0),
                                                       (16, 52, 152, 1), (17, 0, 204, 0)):
        assert timer.silence(now, Connection(True, unacknowledged, acknowledged, 65536)) == silence
