"""Watches the nodes that drive a base on its own simulated clock: whether they have finished the work of a tick."""
from __future__ import annotations

import socket
import threading
from time import monotonic
from typing import Any, Callable, Iterable, Sequence
from urllib.parse import urlparse

import rosgraph
import rospy

from rbx1_nav.ros.network.master import call
from rbx1_nav.ros.network.processes import (
    Network, PollingThread, Process, awake, listening_process, own_process, peer_process, still_polling)
from rbx1_nav.ros.network.tcp import unread_bytes

MASTER = 'the master'
CONNECT_TIME = 5.0      # s of wall time to wait for a new connection of cmd_vel; a busy machine takes more than 1 s
UPSTREAM_PERIOD = 1.0   # s of wall time between two queries of the publishers of all topics


class DrivingNodes:
    """Watches the processes of the nodes that publish commands, and the processes that they may wait for.

    These are the publishers of the topics that the nodes subscribe to (a multiplexer passes on commands from others),
    their publishers, and so on; the master, which serves parameters; and this node, which sends and receives messages.
    The methods must be called by the thread that runs the clock.
    """

    # Any: rospy has no types
    def __init__(self, topic: str, connections: Callable[[], list[Any]],
                 clock_connections: Callable[[], list[Any]]) -> None:
        """topic: the name of cmd_vel; connections(): returns the connections to its publishers; clock_connections():
        returns the connections to the subscribers of /clock."""
        self.topic = topic
        self.connections = connections
        self.clock_connections = clock_connections
        # both kinds of connections and `upstream` at the last update
        self.known: tuple[list[Any], list[Any], set[str]] | None = None
        self.drivers: set[str] = set()      # names of the watched publishers of commands
        self.upstream: set[str] = set()     # names of all nodes that may be a source of commands
        self.watched: set[str] = set()      # `upstream` as update() last used it
        self.upstream_changed = threading.Event()
        self.processes: dict[str, Process] = {}     # by name
        # sockets by name; None: forgotten independently of a connection
        self.forgotten: dict[str, socket.socket | None] = {}
        self.own: Process | None = None     # the process of this node, without the thread that runs the clock
        self.network = Network()
        # by incomplete connection: s of the monotonic clock when it was first seen
        self.new: dict[Any, float] = {}

    def update(self) -> None:
        """Update the set of watched processes. Call this often."""
        connections = [each for each in self.connections() if is_complete(each)]
        listeners = list(self.clock_connections())
        if (connections, listeners, self.upstream) == self.known:
            return
        self.watched = self.upstream
        self.known = connections, listeners, self.watched
        drivers = {each.header['callerid']: each.socket for each in connections if self._can_look()}
        sockets = {each.endpoint_id: each.socket for each in listeners if drivers and each.endpoint_id in self.watched}
        sockets.update(drivers)
        self.forgotten = {name: sock for name, sock in self.forgotten.items() if sock in (None, sockets.get(name))}
        sockets = {name: sock for name, sock in sockets.items() if name not in self.forgotten}
        for name in self.processes.keys() - sockets.keys():
            self.processes.pop(name).close()
        for name, sock in sockets.items():
            if name not in self.processes or self.processes[name].socket is not sock:
                self._watch(name, peer_process(sock), sock)
        self.drivers = drivers.keys() & self.processes.keys()
        if self.drivers:
            self._watch(MASTER, listening_process(urlparse(rosgraph.get_master_uri()).port), None)
            self.upstream_changed.set()

    def _can_look(self) -> bool:
        """Return whether the kernel shows what processes are doing."""
        if self.own is None:
            self.own = own_process()
            if self.own:
                threading.Thread(target=self._look_upstream, daemon=True).start()
        return self.own is not None

    def _watch(self, name: str, process: Process | None, sock: socket.socket | None) -> None:
        if name in self.processes:
            self.processes.pop(name).close()
        if process and name not in self.forgotten:
            process.socket = sock
            self.processes[name] = process

    def sees(self, name: str) -> bool:
        """Return whether the process of a node is watched."""
        self.update()
        return name in self.processes

    def on_clock(self, name: str) -> bool:
        """Return whether a node subscribes to /clock."""
        return any(connection.endpoint_id == name for connection in list(self.clock_connections()))

    def note(self, names: set[str]) -> None:
        """Remember what the processes of these nodes have done so far; call this before waiting until they sleep."""
        for name in names & self.processes.keys():
            self.processes[name].note()

    def mark(self, names: set[str]) -> None:
        """Remember what the processes of these nodes are doing just before a tick."""
        for name in names & self.processes.keys():
            self.processes[name].mark()

    def woke_by_itself(self, name: str) -> bool:
        """Return whether a node may have woken by itself since note()."""
        return name in self.processes and self.processes[name].woke_by_itself()

    def connecting(self) -> bool:
        """Return whether a publisher of commands is connecting. The publisher may consider itself connected a little
        earlier."""
        now = monotonic()
        connections = [each for each in self.connections() if not is_complete(each)]
        self.new = {each: self.new.get(each, now) for each in connections}
        return any(now - begin < CONNECT_TIME for begin in self.new.values())

    def awake(self) -> str | None:
        """Return the name of a node that is awake; None if all are asleep."""
        if self.connecting():
            return self.topic
        self.update()
        if not self.drivers:
            return None
        name: str = rospy.get_name()
        processes = self.processes if not self.own or name in self.forgotten else {**self.processes, name: self.own}
        found = awake(processes.values(), self.network)
        # the name of this node stands for the network
        return next((each for each, process in processes.items() if process is found), name) if found else None

    def awake_drivers(self) -> str | None:
        """Return the name of a publisher of commands that is awake; None if all are asleep."""
        names = sorted(self.drivers)
        process = awake([self.processes[name] for name in names])
        return next((name for name in names if self.processes[name] is process), None)

    def polling(self) -> list[PollingThread]:
        """Return the threads that poll the time instead of waiting for a tick, as an argument for still_polling()."""
        return [each for name in self.drivers & self.processes.keys() for each in self.processes[name].polling()]

    @staticmethod
    def still_polling(threads: list[PollingThread]) -> bool:
        """Return whether one of these threads has not polled since."""
        return still_polling(threads)

    def forget(self, name: str) -> None:
        """Stop watching a node for as long as its connection lasts."""
        process = self.processes.pop(name, None)
        if process:
            self.forgotten[name] = process.socket
            process.close()
        elif name == rospy.get_name():
            self.forgotten[name] = None
        self.drivers = self.drivers - {name}
        self.known = None

    def update_upstream(self) -> bool:
        """Query the publishers of all topics from the master; return whether there are new nodes that may be a source
        of commands."""
        try:
            publishers, subscribers, _ = call(rosgraph.get_master_uri(), 'getSystemState')
        except Exception:       # this thread must continue after any error of the master
            return False
        self.upstream = upstream = upstream_of(self.topic, publishers, subscribers) - {rospy.get_name()}
        return not upstream <= self.watched

    def connected(self, header: object) -> bool:
        """Return whether a connection to a publisher of cmd_vel still exists. header: the header object of the
        connection."""
        return any(connection.header is header for connection in self.connections())

    def unread(self, header: object) -> bool:
        """Return whether a connection has received bytes that have not been read yet."""
        return any(unread_bytes(connection.socket) for connection in self.connections() if connection.header is header)

    def _look_upstream(self) -> None:
        while True:
            self.upstream_changed.wait(UPSTREAM_PERIOD if self.drivers else None)
            self.upstream_changed.clear()
            self.update_upstream()


def is_complete(connection: Any) -> bool:
    """Return whether a publisher has accepted a connection. The header of a refused connection has only an error."""
    return bool(connection.header) and 'callerid' in connection.header


def upstream_of(topic: str, publishers: Iterable[tuple[str, Sequence[str]]],
                subscribers: Iterable[tuple[str, Sequence[str]]]) -> set[str]:
    """Return the names of all nodes whose messages may cause a message on a topic. publishers, subscribers: each topic
    with the names of its nodes, as returned by the master's getSystemState."""
    names_of = dict(publishers)
    found: set[str] = set()
    new = set(names_of.get(topic, ()))
    while new:
        found |= new
        heard = {each for each, names in subscribers if new & set(names)}
        new = {name for each in heard for name in names_of.get(each, ())} - found
    return found
