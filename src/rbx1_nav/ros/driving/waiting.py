"""Waits for the subscribers of a topic, because messages published before they are connected are lost."""
from __future__ import annotations

import threading
from typing import Iterable

import rosgraph
import rospy

from rbx1_nav.ros.driving.watching import Listeners, Peer
from rbx1_nav.ros.network.bases import ask_refusals, namespaces_of_bases
from rbx1_nav.ros.network.master import Server, call
from rbx1_nav.ros.network.rospy_topics import connected_nodes
from rbx1_nav.ros.node.life import wait_for


class _SubscriberMonitor(threading.Thread):
    """Keeps the list of live subscribers of a topic up to date until it is stopped."""

    def __init__(self, topic: str) -> None:
        super().__init__(daemon=True)
        self.topic = topic
        # (address, number of refused commands) of each live subscriber, by its name; None until the master has answered
        self.live: dict[str, tuple[str, int | None]] | None = None
        self.dead: set[str | None] = set()      # addresses
        self.publishers: dict[str, list[str]] = {}      # names of the nodes that publish a topic
        self.odometry: list[str] = []   # topics
        self.others: list[str] = []     # namespaces of other bases
        self.rounds = 0         # number of complete updates of these values
        self.done = threading.Event()

    def run(self) -> None:
        master = rosgraph.get_master_uri()
        while not self.done.is_set():
            try:
                publishers, subscribers, _ = call(master, 'getSystemState')
                self.publishers = dict(publishers)
                self.odometry = [topic for topic, kind in call(master, 'getTopicTypes') if kind == 'nav_msgs/Odometry']
                names = {name for topic, nodes in subscribers if topic == self.topic for name in nodes}
                namespace, commands = self.topic.rpartition('/')[::2]
                self.others = sorted(namespaces_of_bases(self.publishers, dict(subscribers), self.odometry,
                                                         commands).keys() - {namespace or '/'})
                live = {name: self.find(master, name) for name in names}
                self.live = {name: found for name, found in live.items() if found}
                self.rounds += 1
            except Exception as error:
                rospy.logwarn_throttle(5, f'The master at {master} does not answer: {error}')
            self.done.wait(0.1)

    def find(self, master: str, name: str) -> tuple[str, int | None] | None:
        """Return (address, number of refused commands) of a node that answers, else None. An address that did not
        answer is not called again."""
        address = None
        try:
            address = call(master, 'lookupNode', name)
            if address not in self.dead:
                with Server(address) as server:
                    return address, ask_refusals(server)[0]
        except Exception:
            self.dead.add(address)
            rospy.logwarn('%s is registered as a subscriber of %s but does not answer: ignored '
                          '(`rosnode cleanup` removes it)', name, self.topic)
        return None

    def missing_base(self) -> str:
        """Return what is missing if nothing subscribes to the topic."""
        others = (f". Bases exist in other namespaces: {', '.join(self.others)}. To drive one, set "
                  f'ROS_NAMESPACE={self.others[0]}' if self.others else '')
        return f'a base that subscribes to {self.topic}{others}'

    def peer(self, name: str) -> Peer:
        """Return the Peer of this name."""
        uri, refused = (self.live or {}).get(name, (None, None))
        return Peer(name, uri, any(name in self.publishers.get(topic, ()) for topic in self.odometry),
                    name in self.publishers.get('/clock', ()), refused)


def wait_for_subscribers(publisher: rospy.Publisher, timeout: float) -> Listeners:
    """Wait until all live subscribers of a publisher's topic are connected to it and simulated time has started.

    It waits for all subscribers, not only for the first, because that may be a recorder. Returns them as Listeners.

    Raises ROSException if there is no subscriber, or one is missing, after `timeout` seconds of wall time, or if this
    node and the base are on different clocks, and ROSInterruptException as soon as shutdown is requested.
    """
    topic = publisher.resolved_name
    monitor = _SubscriberMonitor(topic)
    monitor.start()
    before: set[str] = set()
    known = 0

    def missing() -> str:
        names = ', '.join(sorted((monitor.live or {}).keys() - before))
        return (f'the master to list the subscribers of {topic}'
                if monitor.live is None or before and monitor.rounds < known
                else f'{names} to connect to {topic}' if names
                else monitor.missing_base() if not before else 'the time on /clock')

    def find() -> Listeners | None:
        nonlocal before, known
        connected = connected_nodes(publisher)
        if connected != before:     # an update in progress may have begun before the change
            before, known = connected, monitor.rounds + 2
        if not (connected and monitor.rounds >= known and (monitor.live or {}).keys() <= connected
                and rospy.get_rostime()):
            return None
        peers = [monitor.peer(name) for name in connected]
        _check_clock(peers)
        return Listeners(publisher, peers)

    try:
        listeners = wait_for(find, timeout, missing)
    finally:
        monitor.done.set()
    listeners.start()
    return listeners


def _check_clock(peers: Iterable[Peer]) -> None:
    """Raise ROSException if a subscriber publishes /clock, but this node, started earlier, does not use it."""
    for peer in peers:
        if peer.keeps_time and rospy.rostime.is_wallclock():
            raise rospy.ROSException('/use_sim_time was false when this node started, but '
                                     f'{peer.name} publishes /clock: start this node again')
