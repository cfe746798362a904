"""Calls to the master and to nodes, over the loopback interface."""
import socket
import threading
from xmlrpc.client import Fault
from xmlrpc.server import SimpleXMLRPCRequestHandler

import pytest
from rosgraph.xmlrpc import ThreadingXMLRPCServer

from rbx1_nav.ros.network.bases import ask_refusals
from rbx1_nav.ros.network.master import Server, call


class Node:
    """A server at a node's address; it counts its connections."""

    def __init__(self):
        self.connections = []
        node = self

        class Handler(SimpleXMLRPCRequestHandler):
            protocol_version = 'HTTP/1.1'

            def setup(self):
                node.connections.append(self.request)
                super().setup()

            def log_message(self, *_):
                pass

        self.server = ThreadingXMLRPCServer(('127.0.0.1', 0))
        self.server.RequestHandlerClass = Handler
        self.server.register_function(lambda caller: (1, '', 7), 'getPid')
        self.uri = 'http://127.0.0.1:%d/' % self.server.server_address[1]
        threading.Thread(target=self.server.serve_forever, args=(0.01,), daemon=True).start()


@pytest.fixture(name='node')
def start_node():
    """Return a Node."""
    node = Node()
    yield node
    node.server.shutdown()
    node.server.server_close()


def test_calls_share_one_connection(node):
    with Server(node.uri) as server:
        assert [server.call('getPid') for _ in range(3)] == [7, 7, 7]
        with pytest.raises(Fault):
            server.call('noMethod')
        assert ask_refusals(server) == (None, '')
    assert len(node.connections) == 1
    assert call(node.uri, 'getPid') == 7
    assert len(node.connections) == 2


def test_a_connection_that_the_node_has_closed_is_made_again(node):
    with Server(node.uri) as server:
        server.call('getPid')
        node.connections[0].shutdown(socket.SHUT_RDWR)
        assert server.call('getPid') == 7
    assert len(node.connections) == 2
