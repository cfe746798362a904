"""Observes the processes of the nodes that drive bases on a simulated clock: whether they have finished their work."""
from __future__ import annotations

from operator import is_
import socket
from time import monotonic
from typing import Any, Callable, Iterable, Sequence
from urllib.parse import urlparse

import rosgraph
import rospy

from rbx1_nav.extras.lockstep.sockets import listening_process, own_process, peer_process
from rbx1_nav.extras.lockstep.processes import (
    Network, PollingThread, Process, Runs, awake, runs_since, still_polling)
from rbx1_nav.node.master import call

# s of wall time to wait for a new connection of cmd_vel; less than NODE_TIMEOUT. A busy machine takes more than 1 s
CONNECT_TIME = 4.0
RECONNECT_TIME = 0.6    # s of wall time: rospy 1.15.9 connects again at once, but reads only 0.5 s later
START_SLEEP = 0.5       # s of wall time for which a node that is starting may sleep by the wall clock
DRIVER_SLEEP = 3.0      # s for which it may do so if it publishes commands


class Watch:
    """Watches the processes of the nodes that publish commands, and the processes that they may wait for.

    These are the publishers of the topics that the nodes subscribe to (a multiplexer passes on commands from others),
    their publishers, and so on; the master, which serves parameters; and this node, which sends and receives messages.
    A node that has just subscribed to the clock may be about to drive, and is also watched, until it waits for
    something. The methods must be called by the thread that runs the clock.
    """

    # Any: rospy has no types
    def __init__(self, clock: rospy.Publisher, greet: Callable[[], bool]) -> None:
        """clock: the publisher of /clock; greet(): sends messages to new subscribers; returns whether there were any.
        """
        self.clock = clock.impl
        self.greet = greet
        self.own_name = rospy.get_name()
        self.commands: list[Any] = []       # the implementations of the subscribers to commands
        # the lists of connections at the last update; rospy replaces a list when it changes
        self.known: list[Any] = []
        self.listeners: dict[str, Any] = {}     # connections to the subscribers of /clock, by name
        self.reads_again = 0.0      # s of the monotonic clock: when a listener that has connected again surely reads
        self.drivers: set[str] = set()      # names of the watched publishers of commands
        self.sources: list[str] = []        # names of all nodes whose messages may cause a command, nearest last
        # nodes that are starting, by name; s of the monotonic clock since when they sleep by the wall clock
        self.starting: dict[str, float | None] = {}
        self.registered: set[str] = set()   # publishers of commands that the master knew when it was last asked
        self.connect_by: float | None = None    # s of the monotonic clock: limit for connecting while they start
        self.processes: dict[str, Process] = {}     # by name, drivers first
        # sockets by name; None: of the master, for good
        self.forgotten: dict[str, socket.socket | None] = {}
        self.own = own_process()        # the process of this node, without the thread that runs the clock
        self.master = listening_process(urlparse(rosgraph.get_master_uri()).port) if self.own else None
        self.network = Network()
        # by incomplete connection: s of the monotonic clock when it was first seen
        self.new: dict[Any, float] = {}

    def add(self, subscriber: rospy.Subscriber) -> None:
        """Watch the publishers that a subscriber to commands is connected to."""
        self.commands.append(subscriber.impl)

    def remove(self, subscriber: rospy.Subscriber) -> None:
        """Undo add()."""
        self.commands.remove(subscriber.impl)

    def update(self) -> bool:
        """Update the set of watched processes; return whether it may have changed. Call this often."""
        now = [self.clock.connections] + [each.connections for each in self.commands]
        if len(now) == len(self.known) and all(map(is_, now, self.known)) and not self.new:
            return False
        self.known = now
        listeners = {each.endpoint_id: each for each in self.clock.connections}
        for name, each in listeners.items():
            if self.listeners.get(name) is not each:
                self.starting[name] = None
                if name in self.listeners:
                    self.reads_again = monotonic() + RECONNECT_TIME
        self.listeners = listeners
        self.starting = {name: until for name, until in self.starting.items() if name in listeners}
        drivers = self.drivers
        self._select()
        if not self.drivers <= drivers:
            self.find_sources()
        return True

    def _connections(self) -> list[Any]:
        return [connection for each in self.commands for connection in each.connections]

    def _select(self) -> None:
        """Watch the processes of drivers, their sources, and nodes that are starting."""
        if not self.own:
            return
        connections = self._connections()
        start = monotonic()
        self.new = {each: self.new.get(each, start) for each in connections if not is_complete(each)}
        # a node that does not subscribe to the clock cannot be in step, so there is no use in waiting for it
        drivers = {each.header['callerid']: each.socket for each in connections
                   if is_complete(each) and each.header['callerid'] in self.listeners}
        others = [name for name in (*self.sources, *self.starting) if name in self.listeners and name not in drivers]
        sockets = {**drivers, **{name: self.listeners[name].socket for name in others}}
        self.forgotten = {name: sock for name, sock in self.forgotten.items() if sock in (None, sockets.get(name))}
        processes = {}
        for name, sock in sockets.items():
            if name in self.forgotten:
                continue
            known = self.processes.get(name)
            # one that was known by another connection is closed below
            process = self.processes.pop(name) if known and known.socket is sock else peer_process(sock)
            if process:
                process.socket = sock
                processes[name] = process
        for process in self.processes.values():
            process.close()
        self.processes = processes
        self.drivers = drivers.keys() & processes.keys()

    def find_sources(self) -> bool:
        """Ask the master who may cause a command; return whether there are new sources of commands."""
        topics = [each.resolved_name for each in self.commands]
        try:
            publishers, subscribers, _ = call(rosgraph.get_master_uri(), 'getSystemState')
        except Exception:       # the clock must continue after any error of the master
            return False
        self.registered = {name for topic, names in publishers if topic in topics for name in names}
        before = set(self.sources)
        self.sources = [each for each in reversed(sources_of(topics, publishers, subscribers))
                        if each != self.own_name]
        self._select()
        return not before >= set(self.sources)

    def groups(self, connections: Sequence[Any]) -> list[tuple[Sequence[Any], bool]]:
        """Return connections to the subscribers of a topic in groups, in the order in which they receive a message, and
        whether to wait after each group: nodes that are not watched, sources of commands one by one, and drivers."""
        by_name = {each.endpoint_id: each for each in connections}
        watched = by_name.keys() & self.processes.keys()
        sources = [name for name in self.sources if name in watched and name not in self.drivers]
        last = sorted(watched - set(sources))
        groups: list[tuple[Sequence[Any], bool]] = [([each for each in connections if each.endpoint_id not in watched],
                                                     False)]
        groups += [([by_name[name]], True) for name in sources]
        return groups + [([by_name[name] for name in last], True)] * bool(last)

    def obstacle(self, name: str) -> str | None:
        """Return the reason why a node that drives cannot be in step, or None."""
        if name not in self.listeners:
            return 'does not subscribe to /clock'
        if name not in self.processes:
            return ('runs on another machine, in another container or as another user, so that its process is not '
                    'visible from here')
        return None

    def _is_connecting(self) -> bool:
        """Return whether a publisher of commands is connecting. The publisher may consider itself connected a little
        earlier."""
        now = monotonic()
        return any(not is_complete(each) and now - begin < CONNECT_TIME for each, begin in self.new.items())

    def awake(self) -> str | None:
        """Return the name of a node that is awake, connecting or starting; None if all are asleep."""
        self.update()
        if not self.own:
            return None
        if self._is_connecting():
            return self.commands[0].resolved_name
        if monotonic() < self.reads_again:
            return '/clock'
        names, processes = list(self.processes), list(self.processes.values())
        for name, process in ((MASTER, self.master), (self.own_name, self.own)):
            if process and name not in self.forgotten:
                names.append(name)
                processes.append(process)
        found = awake(processes, self.network)
        if found:
            # the name of this node stands for the network
            return names[processes.index(found)] if isinstance(found, Process) else self.own_name
        # now, so that the first time that a node sees does not depend on how fast it starts
        return self.own_name if self.greet() else self._still_starting()

    def _still_starting(self) -> str | None:
        """Return the name of a node that is starting: it sleeps by the wall clock, or it has registered as a publisher
        of commands and is not connected yet. None if there is none."""
        if not self.starting:
            return None
        now = monotonic()
        sleeping = []
        for name, since in list(self.starting.items()):
            process = self.processes.get(name)
            if process and process.main_sleeps_briefly():
                self.starting[name] = since = since or now
                if now < since + START_SLEEP:
                    return name
                if now < since + DRIVER_SLEEP:
                    sleeping.append(name)
        if not self.registered.intersection(sleeping):
            self.find_sources()
        if self.registered.intersection(sleeping):
            return sleeping[0]
        connected = {each.header['callerid'] for each in self._connections() if is_complete(each)}
        for name in self.starting.keys() & self.registered - connected:
            self.connect_by = self.connect_by or now + CONNECT_TIME
            if now < self.connect_by:
                return name
        self.starting, self.connect_by = {}, None
        self._select()
        return None

    def polling(self) -> list[PollingThread]:
        """Return the threads that poll the time instead of waiting for a message, as an argument for
        still_polling()."""
        return [each for process in self.processes.values() for each in process.polling()]

    def have_new_threads(self) -> bool:
        """Return whether there are new threads in the watched nodes since the last call."""
        return any([process.has_new_threads() for process in self.processes.values()])

    def runs(self) -> Runs:
        """Return how often each thread of the watched nodes has run."""
        return [each for process in self.processes.values() for each in process.runs()]

    @staticmethod
    def find_pollers(before: Runs) -> bool:
        """Look for threads that have run although nothing was delivered since runs(); return whether it is still
        uncertain for one of them."""
        runs = runs_since(before)
        for thread, count in runs:
            thread.is_poller = thread.is_poller or count > 1
        return any(count == 1 for _, count in runs)

    @staticmethod
    def still_polling(threads: list[PollingThread]) -> bool:
        """Return whether one of these threads has not polled since."""
        return still_polling(threads)

    def forget(self, name: str) -> bool:
        """Stop watching a node for as long as its connection lasts; return whether it was more than starting."""
        watched = name not in self.starting or name in self.drivers or name in self.sources
        self.starting.pop(name, None)
        process = self.processes.pop(name, None)
        if process:
            self.forgotten[name] = process.socket
            process.close()
        elif name == MASTER:
            self.forgotten[name] = None
        self.drivers = self.drivers - {name}
        self.known = []
        return watched

    def has_started(self, name: str) -> None:
        """Note that a node has sent its first command."""
        self.starting.pop(name, None)

    def is_connected(self, header: object) -> bool:
        """Return whether a connection to a publisher of commands still exists. header: the header object of the
        connection."""
        return any(connection.header is header for connection in self._connections())


MASTER = 'the master'


def is_complete(connection: Any) -> bool:
    """Return whether a publisher has accepted a connection. The header of a refused connection has only an error."""
    return bool(connection.header) and 'callerid' in connection.header


def sources_of(topics: Iterable[str], publishers: Iterable[tuple[str, Sequence[str]]],
               subscribers: Iterable[tuple[str, Sequence[str]]]) -> list[str]:
    """Return the names of all nodes whose messages may cause a message on one of the topics, nearest first.

    publishers, subscribers: each topic with the names of its nodes, as returned by the master's getSystemState.
    """
    names_of = dict(publishers)
    found: list[str] = []
    new = {name for topic in topics for name in names_of.get(topic, ())}
    while new:
        found += sorted(new)
        heard = {each for each, names in subscribers if new & set(names)}
        new = {name for each in heard for name in names_of.get(each, ())} - set(found)
    return found
