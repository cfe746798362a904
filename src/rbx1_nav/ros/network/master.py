"""Calls to the master and to other nodes that give up after a while, where rospy's own would wait for ever."""
import threading
import time
from urllib.parse import urlsplit
from xmlrpc.client import ServerProxy, Transport
import xmlrpc.client

import rosgraph
import rospy

TIMEOUT = 2.0       # s of wall time in which the master, or a live node, answers a call
PERIOD = 0.2        # s between two calls to a master that is not running yet; rospy has the same


class _TimeoutTransport(Transport):
    """XML-RPC with a timeout."""

    def __init__(self, timeout):
        super().__init__()
        self.timeout = timeout

    def make_connection(self, host):
        connection = super().make_connection(host)
        connection.timeout = self.timeout
        return connection


class Server:
    """The master or a node. Keeps its connection from call to call, and makes a new one if a call fails."""

    def __init__(self, uri, timeout=TIMEOUT):
        """timeout: s."""
        self._proxy = ServerProxy(uri, transport=_TimeoutTransport(timeout))

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self._proxy('close')()

    def call(self, method, *args):
        """The result of a call. Raises OSError, http.client.HTTPException or xmlrpc.client.Error if it fails."""
        return getattr(self._proxy, method)(rospy.get_name(), *args)[2]


def call(uri, method, *args, timeout=TIMEOUT):
    """The result of one call, as of Server.call()."""
    with Server(uri, timeout) as server:
        return server.call(method, *args)


def require_master():
    """Raises ROSException if the master does not answer."""
    try:
        call(rosgraph.get_master_uri(), 'getPid')
    except (OSError, xmlrpc.client.Error) as error:
        raise rospy.ROSException('The master at %s does not answer (%s): expected a running roscore'
                                 % (rosgraph.get_master_uri(), error))


class _MasterProbe(threading.Thread):
    """Calls the master until it answers: in a thread, so that a host that drops packets delays no Ctrl-C."""

    def __init__(self):
        super().__init__(daemon=True)
        self.answered = threading.Event()
        self.failed = threading.Event()     # at least once
        self.done = threading.Event()

    def run(self):
        while not self.done.is_set():
            try:
                require_master()
                self.answered.set()
                return
            except Exception:   # pylint: disable=broad-except
                self.failed.set()       # another server at this port raises errors of its own
            time.sleep(PERIOD)


def wait_for_master(name, read_limit, is_ended, sleep):
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
                raise rospy.ROSException('The master at %s does not answer (timed out after %g s): '
                                         'expected a running roscore' % (uri, limit))
            sleep(0.02)
    finally:
        probe.done.set()
