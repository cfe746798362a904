"""Waits for the subscribers of a topic, because messages published before they are connected are lost."""
from __future__ import annotations

import socket
import time

import rosgraph
import rospy

from rbx1_nav.ros.driving.watching import Listeners, Peer
from rbx1_nav.ros.network.bases import ask_refusals, namespaces_of_bases
from rbx1_nav.ros.network.master import Server, call
from rbx1_nav.ros.network.rospy_topics import connected_nodes
from rbx1_nav.ros.node.life import wait_for

PERIOD = 0.1        # s between two questions to the master


class _Subscribers:
    """The live subscribers of a topic."""

    def __init__(self, topic: str, exact: bool) -> None:
        self.topic = topic
        self.exact = exact
        self.peers: dict[str, Peer] | None = None       # by name; None until the master has answered
        self.dead: set[str | None] = set()      # addresses
        self.silent: list[str] = []     # bases that may be suspended: they have not answered, but exist
        self.others: list[str] = []     # namespaces of other bases
        self.next = 0.0     # s of the monotonic clock

    def update(self) -> None:
        """Ask the master and the subscribers, unless it is too early."""
        if time.monotonic() < self.next:
            return
        master = rosgraph.get_master_uri()
        try:
            state: list[dict[str, list[str]]] = [dict(each) for each in call(master, 'getSystemState')]
            publishers, subscribers, _ = state
            odometry = [topic for topic, kind in call(master, 'getTopicTypes') if kind == 'nav_msgs/Odometry']
            namespace, commands = self.topic.rpartition('/')[::2]
            self.others = sorted(namespaces_of_bases(publishers, subscribers, odometry, commands).keys()
                                 - {namespace or '/'})
            names = subscribers.get(self.topic, [])
            drivers = publishers.get(self.topic, ())     # such as the page in the browser, which also listens
            self.silent = []
            found = [self.find(master, name, any(name in publishers.get(topic, ()) for topic in odometry),
                               name in publishers.get('/clock', ())) for name in names]
            self.peers = {peer.name: peer for peer in found if peer and (peer.is_base or peer.name not in drivers)}
        except Exception as error:
            rospy.logwarn_throttle(5, f'The master at {master} does not answer: {error}')
        self.next = time.monotonic() + PERIOD

    def find(self, master: str, name: str, is_base: bool, keeps_time: bool) -> Peer | None:
        """Return the Peer of this name if it answers. An address that did not answer is not called again, unless a base
        may be suspended there."""
        address = None
        try:
            address = call(master, 'lookupNode', name)
            if address not in self.dead:
                with Server(address) as server:
                    return Peer(name, address, is_base, keeps_time, ask_refusals(server, self.exact)[0])
        except Exception as error:
            if is_base and isinstance(error, socket.timeout):
                self.silent.append(name)
                return None
            self.dead.add(address)
            rospy.logwarn('%s is registered as a subscriber of %s but does not answer: ignored '
                          '(`rosnode cleanup` removes it)', name, self.topic)
        return None

    def missing_base(self) -> str:
        """Return what is missing if nothing subscribes to the topic."""
        others = (f". Bases exist in other namespaces: {', '.join(self.others)}. To drive one, set "
                  f'ROS_NAMESPACE={self.others[0]}' if self.others else '')
        return f'a base that subscribes to {self.topic}{others}'


def wait_for_subscribers(publisher: rospy.Publisher, timeout: float, exact: bool) -> Listeners:
    """Wait until all live subscribers of a publisher's topic are connected to it and simulated time has started.

    It waits for all subscribers, not only for the first, because that may be a recorder. Returns them as Listeners.
    exact: whether the script relies on each command, so that one that the base clamps, or that comes too late, is an
    error.

    Raises ROSException if there is no subscriber, or one is missing, after `timeout` seconds of wall time, or if this
    node and the base are on different clocks, and ROSInterruptException as soon as shutdown is requested.
    """
    topic = publisher.resolved_name
    subscribers = _Subscribers(topic, exact)

    def missing() -> str:
        peers, connected = subscribers.peers, connected_nodes(publisher)
        return (f'the master to list the subscribers of {topic}' if peers is None
                else f"{', '.join(sorted(peers.keys() - connected))} to connect to {topic}" if peers.keys() - connected
                else f"{', '.join(subscribers.silent)} to answer" if subscribers.silent
                else 'the time on /clock' if peers else subscribers.missing_base())

    def find() -> Listeners | None:
        subscribers.update()
        peers = subscribers.peers or {}
        if subscribers.silent and not any(peer.is_base for peer in peers.values()):
            return None
        if not (peers and peers.keys() <= connected_nodes(publisher) and rospy.get_rostime()):
            return None
        for peer in peers.values():
            if peer.keeps_time and rospy.rostime.is_wallclock():
                raise rospy.ROSException('/use_sim_time was false when this node started, but '
                                         f'{peer.name} publishes /clock: start this node again')
        return Listeners(publisher, peers, exact)

    return wait_for(find, timeout, missing)
