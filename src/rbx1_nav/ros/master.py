"""Calls to the master and to other nodes that give up after a while, where rospy's own would wait for ever."""
from xmlrpc.client import ServerProxy, Transport
import xmlrpc.client

import rosgraph
import rospy

TIMEOUT = 2.0       # s of wall time in which the master, or a live node, answers a call


class _TimeoutTransport(Transport):
    """XML-RPC with a timeout."""

    def __init__(self, timeout):
        super().__init__()
        self.timeout = timeout

    def make_connection(self, host):
        connection = super().make_connection(host)
        connection.timeout = self.timeout
        return connection


def call(uri, method, *args, timeout=TIMEOUT):
    """The result of a call to the master or a node; timeout: s. Raises OSError or xmlrpc.client.Error if it fails."""
    with ServerProxy(uri, transport=_TimeoutTransport(timeout)) as server:
        return getattr(server, method)(rospy.get_name(), *args)[2]


def require_master():
    """Raises ROSException if the master does not answer."""
    try:
        call(rosgraph.get_master_uri(), 'getPid')
    except (OSError, xmlrpc.client.Error) as error:
        raise rospy.ROSException('The master at %s does not answer (%s): expected a running roscore'
                                 % (rosgraph.get_master_uri(), error))
