"""Messages are sent directly to a subscriber, unless its connection has older ones to send."""
import socket
import threading
import time
from types import SimpleNamespace

import pytest
from rospy.impl.tcpros_pubsub import QueuedConnection

from rbx1_nav.ros.lockstep.lockstep import write


@pytest.fixture(name='connection')
def make_connection():
    """A connection of rospy with a thread. connection.sent: pairs of data and whether the test's own thread sent it."""
    ours, theirs = socket.socketpair()
    ours.setblocking(False)
    raw = SimpleNamespace(done=False, socket=ours, sent=[], theirs=theirs, set_cleanup_callback=lambda _: None)
    raw.write_data = lambda data: raw.sent.append((data, threading.current_thread() is threading.main_thread()))
    connection = QueuedConnection(raw, 10)
    wait_for(lambda: connection._cond_data_available._waiters)
    yield connection
    raw.done = True
    connection._closed_connection_callback(raw)
    connection._thread.join()
    ours.close()
    theirs.close()


def wait_for(condition):
    end = time.monotonic() + 60
    while not condition():
        assert time.monotonic() < end, 'timed out'


def test_a_message_to_a_receiver_that_does_not_read_is_queued(connection):
    with pytest.raises(BlockingIOError):
        while True:
            connection.socket.send(bytes(1000))
    write(connection, b'one')
    wait_for(lambda: connection.sent)
    assert connection.sent == [(b'one', False)]


def test_messages_do_not_overtake_each_other(connection):
    with connection._lock:
        connection._queue.append(b'one')
        connection._cond_data_available.notify()
    write(connection, b'two')
    wait_for(lambda: len(connection.sent) == 2)
    assert connection.sent == [(b'one', False), (b'two', False)]
