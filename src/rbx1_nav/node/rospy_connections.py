"""The connections of rospy: messages are sent at once, and no connection is missed or held up."""
from __future__ import annotations

from contextlib import nullcontext
import socket
import threading
from typing import Any, Callable, ContextManager, Sequence

import rospy
from rospy.impl.registration import RegManager
from rospy.impl.tcpros_base import TCPROSServer
from rospy.topics import get_topic_manager

HEADER_TIME = 0.2   # s in which a client usually sends its header
_read_header = TCPROSServer._tcp_server_callback
_create = rospy.Publisher.__init__
_creating = threading.Lock()    # held while a publisher is created
_connect = RegManager._connect_topic_thread
_connecting: dict[tuple[str, str], threading.Lock] = {}     # by topic and URI
# surrounds each connection of a subscriber to a topic; a simulated clock replaces the function
gates: list[Callable[[str], ContextManager[Any]]] = [nullcontext]


class NoDelay(rospy.SubscribeListener):
    """Sets TCP_NODELAY for each subscriber of a publisher, and may send it messages at once.

    rospy does this only if the subscriber asks for it. Without it, messages may arrive in bursts of 30 to 60 ms.
    """

    # Any: rospy has no types
    def __init__(self, greet: Callable[[str, Callable[[Any], None]], None] | None = None) -> None:
        """greet(topic, publish): sends messages to a new subscriber."""
        self.greet = greet

    def peer_subscribe(self, topic_name: str, _: Any, peer_publish: Callable[[Any], None]) -> None:
        for connection in get_topic_manager().get_publisher_impl(topic_name).connections:
            try:
                connection.socket.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
            except (AttributeError, OSError):       # closed
                pass
        if self.greet:
            self.greet(topic_name, peer_publish)


def connected_nodes(publisher: rospy.Publisher) -> set[str]:
    """Return the names of the nodes that are connected to a publisher."""
    return {connection.endpoint_id for connection in publisher.impl.connections}


def repair_connections() -> None:
    """Repair four faults of rospy, in this process; to be called before the node starts.

    rospy connects a subscriber to the publishers in the last list that it has received, and drops a list that it has
    not used yet. A publisher that registers at the same moment as the subscriber is in the master's notice, but not in
    the answer to the registration of the subscriber. If the answer comes last, they are never connected.

    rospy passes on a notice of the master once per publisher, and may connect to each of them as often. Each connection
    replaces the one before, whose messages may be lost, and the publisher finds its subscriber disconnected.

    rospy accepts connections in one thread, which also waits for the header of each connection, without a limit. After
    a client that sends none, such as a port scanner or a computer that has left the network, nobody can connect.

    rospy registers a publisher before it sets the size of the queue and the SubscribeListener. A subscriber that
    connects in between never has a queue, and the listener does not hear of it.
    """
    RegManager.publisher_update = _update_publishers
    RegManager._connect_topic_thread = _connect_one_at_a_time
    TCPROSServer._tcp_server_callback = _read_header_in_thread
    rospy.Publisher.__init__ = _create_before_connections


def _create_before_connections(*args: Any, **keywords: Any) -> None:
    """Create a publisher; who connects to it waits until it is complete."""
    with _creating:
        _create(*args, **keywords)


def _read_header_in_thread(server: TCPROSServer, connection: socket.socket, address: tuple[str, int]) -> None:
    """Read the header of a connection, and add the connection to its topic or service. The next connection waits, so
    that a node that subscribes to /clock first is first known as a listener to it; but only for a while."""
    with _creating:     # before the thread: of two connections of a node, rospy keeps the one that is added last
        pass
    thread = threading.Thread(target=_read_header, args=(server, connection, address), daemon=True)
    thread.start()
    thread.join(HEADER_TIME)


def _update_publishers(manager: RegManager, topic: str, publishers: Sequence[str]) -> None:
    """Add a list of publishers (URIs) to those that rospy has not used yet. A publisher that no longer exists does not
    harm: it refuses the connection."""
    with manager.cond:
        unused = [uri for name, uris in manager.updates if name == topic for uri in uris]
        manager.updates.append((topic, list(dict.fromkeys([*unused, *publishers]))))
        manager.cond.notify_all()


def _connect_one_at_a_time(manager: RegManager, topic: str, uri: str) -> None:
    """Connect to a publisher. A second thread waits, and finds the connection."""
    with _connecting.setdefault((topic, uri), threading.Lock()), gates[-1](topic):
        _connect(manager, topic, uri)
