"""Calls to the master and to other nodes that give up after a while, where rospy's own would wait for ever."""
from __future__ import annotations

from http.client import HTTPConnection
import threading
import time
from typing import Any, Callable
from urllib.parse import urlsplit
from xmlrpc.client import ServerProxy, Transport
import xmlrpc.client

import rosgraph
import rospy

TIMEOUT = 2.0       # s of wall time in which the master, or a live node, answers a call
PERIOD = 0.2        # s between two calls to a master that is not running yet; rospy has the same


class _TimeoutTransport(Transport):
    """XML-RPC with a timeout."""

    def __init__(self, timeout: float) -> None:
        super().__init__()
        self.timeout = timeout

    def make_connection(self, host: tuple[str, dict[str, str]] | str) -> HTTPConnection:
        connection = super().make_connection(host)
        connection.timeout = self.timeout
        return connection


class Server:
    """The master or a node. Keeps its connection from call to call, and makes a new one if a call fails."""

    def __init__(self, uri: str, timeout: float = TIMEOUT) -> None:
        """timeout: s."""
        self._proxy = ServerProxy(uri, transport=_TimeoutTransport(timeout))

    def __enter__(self) -> Server:
        return self

    def __exit__(self, *_: object) -> None:
        self._proxy('close')()

    # Any: what a call returns depends on its method
    def call(self, method: str, *args: str) -> Any:
        """The result of a call. Raises OSError, http.client.HTTPException or xmlrpc.client.Error if it fails."""
        return getattr(self._proxy, method)(rospy.get_name(), *args)[2]


def call(uri: str, method: str, *args: str, timeout: float = TIMEOUT) -> Any:
    """The result of one call, as of Server.call()."""
    with Server(uri, timeout) as server:
        return server.call(method, *args)


def require_master() -> None:
    """Raises ROSException if the master does not answer."""
    try:
        call(rosgraph.get_master_uri(), 'getPid')
    except (OSError, xmlrpc.client.Error) as error:
        raise rospy.ROSException(f'The master at {rosgraph.get_master_uri()} does not answer ({error}): '
                                 'expected a running roscore') from error


class _MasterProbe(threading.Thread):
    """Calls the master until it answers: in a thread, so that a host that drops packets delays no Ctrl-C."""

    def __init__(self) -> None:
        super().__init__(daemon=True)
        self.answered = threading.Event()
        self.failed = threading.Event()     # at least once
        self.done = threading.Event()

    def run(self) -> None:
        while not self.done.is_set():
            try:
                require_master()
                self.answered.set()
                return
            except Exception:
                self.failed.set()       # another server at this port raises errors of its own
            time.sleep(PERIOD)


def wait_for_master(name: str, read_limit: Callable[[], float | None], is_ended: Callable[[], bool],
                    sleep: Callable[[float], None]) -> None:
    """Wait until the master answers, or is_ended(), and log one line if it does not answer at once.

    name: of the node, for the log; sleep(seconds): sleeps for a moment; read_limit(): how long to wait, s of wall time,
    None for no limit; it is called only if there is something to wait for. Raises ROSException after this time.
    """
    uri = rosgraph.get_master_uri()
    if urlsplit(uri).scheme != 'http':      # rospy reports it
        return
    probe = _MasterProbe()
    start = time.monotonic()
    probe.start()
    try:
        while not (probe.answered.is_set() or probe.failed.is_set() or is_ended()):
            sleep(0.002)
        if probe.answered.is_set() or is_ended():
            return
        rospy.core.configure_logging(name)      # as init_node() would, for the line to look like any other
        limit = read_limit()
        rospy.loginfo('Waiting for the master at %s', uri)
        while not (probe.answered.is_set() or is_ended()):
            if limit is not None and time.monotonic() > start + limit:
                raise rospy.ROSException(f'The master at {uri} does not answer (timed out after {limit:g} s): '
                                         'expected a running roscore')
            sleep(0.02)
    finally:
        probe.done.set()
