"""Calls to the master and to other nodes with a timeout; rospy's own calls would wait indefinitely."""
from __future__ import annotations

from http.client import HTTPConnection, HTTPException
import socket
from typing import Any
from xmlrpc.client import ServerProxy, Transport
import xmlrpc.client

import rosgraph
import rospy

TIMEOUT = 2.0       # s of wall time for the master, or a live node, to answer a call


class _TimeoutTransport(Transport):
    def __init__(self, timeout: float) -> None:
        super().__init__()
        self.timeout = timeout

    def make_connection(self, host: tuple[str, dict[str, str]] | str) -> HTTPConnection:
        connection = super().make_connection(host)
        connection.timeout = self.timeout
        return connection


class Server:
    """The master or a node. The connection is kept between calls, and replaced after a call that failed."""

    def __init__(self, uri: str, timeout: float = TIMEOUT) -> None:
        """timeout: s."""
        self._proxy = ServerProxy(uri, transport=_TimeoutTransport(timeout))

    def __enter__(self) -> Server:
        return self

    def __exit__(self, *_: object) -> None:
        self._proxy('close')()

    # Any: what a call returns depends on its method
    def call(self, method: str, *args: str | float) -> Any:
        """Return the result of a call. Raises OSError, http.client.HTTPException or xmlrpc.client.Error if it fails."""
        return getattr(self._proxy, method)(rospy.get_name(), *args)[2]

    def param(self, name: str, default: object) -> Any:
        """Return the value of a parameter, or the default if it is not set. Raises like call()."""
        return self.call('getParam', name) if self.call('hasParam', name) else default


def call(uri: str, method: str, *args: str | float) -> Any:
    """Return the result of one call, like Server.call()."""
    with Server(uri) as server:
        return server.call(method, *args)


def is_alive(name: str) -> bool:
    """Return whether a node is registered, and answers or may be alive on a host that cannot be reached. Raises like
    Server.call() if the master does not answer."""
    address = call(rosgraph.get_master_uri(), 'lookupNode', name)
    try:
        return bool(call(address, 'getPid'))
    except (socket.timeout, socket.gaierror):   # suspended; its host drops packets, or has no address here
        return True
    except Exception:       # nothing, or another program, listens at the port of a node that was killed
        return False


def require_master() -> None:
    """Raise ROSException if the master does not answer."""
    try:
        call(rosgraph.get_master_uri(), 'getPid')
    except (OSError, HTTPException, xmlrpc.client.Error) as error:
        raise rospy.ROSException(f'The master at {rosgraph.get_master_uri()} does not answer ({error}): '
                                 'expected a running roscore') from error
