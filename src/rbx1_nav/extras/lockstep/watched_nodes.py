"""Observes the processes of the nodes that drive bases on a simulated clock: whether they have finished their work."""
from __future__ import annotations

from contextlib import contextmanager
from operator import is_, itemgetter
import socket
from threading import Event
from time import monotonic
from typing import Any, Callable, Iterator
from urllib.parse import urlparse

import rosgraph
import rospy

from rbx1_nav.extras.lockstep.command_sources import Graph
from rbx1_nav.extras.lockstep.processes import Network, Process, find_awake
from rbx1_nav.extras.lockstep.sockets import listening_process, own_process, peer_process
from rbx1_nav.node.master import call

# s of wall time to wait for a new connection of cmd_vel; less than NODE_TIMEOUT. A busy machine takes more than 1 s
CONNECT_TIME = 4.0
RECONNECT_TIME = 0.6    # s of wall time: rospy 1.15.9 connects again at once, but reads only 0.5 s later
START_SLEEP = 0.5       # s of wall time for which a node that is starting may sleep by the wall clock
DRIVER_SLEEP = 3.0      # s for which it may do so if it publishes commands
SPIN = 0.2              # s: who sleeps a second time, and for longer than this, waits for no connection
AWAKE_TIME = 2.0        # s of wall time: a publisher of commands is connected, even if a node is still awake
MASTER_WORK = 100_000   # ns of CPU time: the master has answered a call (0.2 to 1 ms; 0.07 ms to look for work)


class Permission(Event):
    """To connect to a publisher of commands."""

    since = 0.0     # s of the monotonic clock: when it was given


class Watch:
    """Watches the processes of the nodes that publish commands, and the processes that they may wait for.

    These are the publishers of the topics that the nodes subscribe to (a multiplexer passes on commands from others),
    their publishers, and so on; the master, which serves parameters; and this node, which sends and receives messages.
    A node that has just subscribed to the clock may be about to drive, and is also watched, until it waits for
    something. The methods must be called by the thread that runs the clock.
    """

    # Any: rospy has no types
    def __init__(self, clock: rospy.Publisher) -> None:
        """clock: the publisher of /clock."""
        self.clock = clock.impl
        # for each new subscriber False if it is one of /clock, which come first, and a function that sends a message;
        # any thread may append to this list
        self.greetings: list[tuple[bool, Callable[[], None]]] = []
        self.own_name = rospy.get_name()
        # the implementations of the subscribers to commands, whose publishers are watched
        self.commands: list[Any] = []
        # the lists of connections at the last update; rospy replaces a list when it changes
        self.known: list[Any] = []
        self.listeners: dict[str, Any] = {}     # connections to the subscribers of /clock, by name
        self.reads_again = 0.0      # s of the monotonic clock: when a listener that has connected again surely reads
        self.drivers: set[str] = set()      # names of the watched publishers of commands
        # nodes that are starting, by name; s of the monotonic clock since when they sleep by the wall clock, and how
        # often their main thread had run. Another thread may remove some
        self.starting: dict[str, tuple[float, int] | None] = {}
        self.graph = Graph()
        self.master_time = 0    # ns of CPU time that the master had used when all nodes were asleep
        self.asked = False      # whether the work of the master since then was the answer
        self.news = Event()     # set if the master has to be asked in any case
        # registered nodes that are not connected, by name; s of the monotonic clock when first missed
        self.missed: dict[str, float] = {}
        self.joining: list[Permission] = []     # for the connections that are being made; any thread may change this
        self.processes: dict[str, Process] = {}     # by name; drivers first
        # sockets by name; None: of the master, for good
        self.forgotten: dict[str, socket.socket | None] = {}
        self.own = own_process()        # the process of this node, without the thread that runs the clock
        self.master = listening_process(urlparse(rosgraph.get_master_uri()).port) if self.own else None
        self.network = Network()

    def update(self) -> bool:
        """Update the set of watched processes; return whether it may have changed. Call this often."""
        now = [self.clock.connections] + [each.connections for each in self.commands]
        if len(now) == len(self.known) and all(map(is_, now, self.known)):
            return bool(self.joining)
        # the header of an incomplete connection will come without a change of the list
        self.known = now if all(map(is_complete, self._connections())) else []
        listeners = {each.endpoint_id: each for each in self.clock.connections}
        for name, each in listeners.items():
            if self.listeners.get(name) is not each:
                self.starting[name] = None
                self.missed.pop(name, None)
                self.news.set()     # what it has registered while the master was asked is in no answer
                if name in self.listeners:
                    self.reads_again = monotonic() + RECONNECT_TIME
        for name in self.listeners.keys() - listeners.keys():
            self.missed[name] = 0.0     # it may have been killed: not waited for until it unregisters
        self.listeners = listeners
        self.starting = {name: since for name, since in list(self.starting.items()) if name in listeners}
        self._select()
        return True

    def _connections(self) -> list[Any]:
        return [connection for each in self.commands for connection in each.connections]

    def _select(self) -> None:
        """Watch the processes of drivers, their sources, and nodes that are starting."""
        if not self.own:
            return
        # a node that does not subscribe to the clock cannot be in step, so there is no use in waiting for it
        drivers = {each.header['callerid']: each.socket for each in self._connections()
                   if is_complete(each) and each.header['callerid'] in self.listeners}
        others = {name: self.listeners[name].socket for name in (*self.graph.sources, *self.starting)
                  if name in self.listeners and name not in drivers}
        sockets = {**drivers, **others}
        self.forgotten = {name: sock for name, sock in self.forgotten.items() if sock in (None, sockets.get(name))}
        processes = {}
        for name, sock in sockets.items():
            if name in self.forgotten:
                continue
            process = self.processes.get(name)
            if not process or process.socket is not sock:
                process = peer_process(sock)
            if process:
                process.socket = sock
                processes[name] = process
        self.processes = processes
        self.drivers = drivers.keys() & processes.keys()

    def find_sources(self) -> bool:
        """Ask the master who may cause a command; return whether there are new sources of commands."""
        before = set(self.graph.sources)
        topics = {each.resolved_name for each in self.commands}
        try:
            types = call(rosgraph.get_master_uri(), 'getTopicTypes')
            publishers, subscribers, _ = call(rosgraph.get_master_uri(), 'getSystemState')
        except Exception:       # the clock must continue after any error of the master
            return False
        others = {topic for topic, kind in types if any(kind == each.type for each in self.commands)}
        relays = self.graph.update(publishers, subscribers, topics, others, self.clock.resolved_name, self.own_name)
        for name in sorted(relays.difference(self.starting)):
            rospy.logwarn('%s has advertised %s only now: the command for which it did so is lost. Before the first '
                          'run, send a zero command, and wait for a second', name, ', '.join(sorted(topics)))
        self.missed = {name: since for name, since in self.missed.items() if name in self.graph.registered}
        self._select()
        return not before >= set(self.graph.sources)

    def groups(self, topic: Any) -> list[tuple[list[Any], bool]]:
        """Return the connections to the subscribers of a topic in groups, in the order in which they receive a message,
        and whether to wait after each group: nodes that are not watched, sources of commands one by one, and drivers.
        topic: the implementation of a publisher. A new subscriber of the clock is first greeted, when it is asleep."""
        connections = list(self.listeners.values()) if topic is self.clock else topic.connections
        by_name = {each.endpoint_id: each for each in connections}
        watched = by_name.keys() & self.processes.keys()
        sources = [name for name in self.graph.sources if name in watched and name not in self.drivers]
        last = sorted(watched - set(sources))
        groups = [([each for each in connections if each.endpoint_id not in watched], False),
                  *(([by_name[name]], True) for name in sources), ([by_name[name] for name in last], True)]
        return [group for group in groups if group[0]]

    def obstacle(self, name: str) -> str | None:
        """Return the reason why a node that drives cannot be in step, or None."""
        if name not in self.listeners:
            return 'does not subscribe to /clock'
        return None if name in self.processes else (
            'runs on another machine, in another container or as another user, so that its process is not visible '
            'from here')

    def waits_for(self) -> str | None:
        """Return the name of a node that is awake, or a text about one that is connecting or starting; None if all are
        asleep."""
        # before the update, which finds the nodes that receive them
        greetings, joining = len(self.greetings), list(self.joining)
        self.update()
        if monotonic() < self.reads_again:
            return 'a node that has connected again'
        naps = self._naps()     # before the check, which finds whatever wakes after this
        watched = {**self.processes, MASTER: self.master, self.own_name: self.own}
        processes = {process: name for name, process in watched.items() if process and name not in self.forgotten}
        found = find_awake(processes, self.network)
        if found:
            return processes[found] if isinstance(found, Process) else self.own_name    # or messages are in transit
        naps |= self._naps()    # a thread may have waited for a lock before
        connected = {each.header['callerid'] for each in self._connections() if is_complete(each)}
        unconnected = (self.graph.registered & self.listeners.keys()) - self.forgotten.keys() - connected
        asked = self._ask_master()
        return (self._greet(greetings) or asked or self._missed(self.graph.on_clock - self.listeners.keys())
                or self._join(joining) or self._missed(unconnected)
                or self._sleeps_by_the_wall_clock(naps))

    def _naps(self) -> set[str]:
        """Return the names of nodes that are starting, and are running or sleep by the wall clock."""
        return {name for name in list(self.starting) if name in self.processes and self.processes[name].naps()}

    def _ask_master(self) -> str | None:
        """Ask the master for publishers of commands if it has worked; then return the name of this node, because others
        may have woken meanwhile."""
        used = self.master and self.master.activity() or 0
        if self.news.is_set() or not self.asked and used > self.master_time + MASTER_WORK:
            self.news.clear()
            self.asked = True
            self.find_sources()
            return self.own_name
        self.master_time, self.asked = used, False
        return None

    def _greet(self, count: int) -> str | None:
        """Send the first greetings, so many: the first time that a node sees does not depend on how fast it starts."""
        for _, send in sorted(self.greetings[:count], key=itemgetter(0)):
            send()
        del self.greetings[:count]
        return self.own_name if count else None

    def _missed(self, names: set[str]) -> str | None:
        """Return whether to wait for one of these nodes, which are not connected, as waits_for() does."""
        now = monotonic()
        late = [name for name in sorted(names) if now < self.missed.setdefault(name, now) + CONNECT_TIME]
        return STARTING % late[0] if late else None

    def _join(self, joining: list[Permission]) -> str | None:
        """Let publishers of commands connect; return whether they do so, as waits_for() does."""
        now = monotonic()
        for each in joining:
            each.since = each.since or now
            each.set()
        waits = any(now < each.since + CONNECT_TIME for each in joining if each in self.joining)
        return STARTING % 'a publisher of commands' if waits else None

    def _sleeps_by_the_wall_clock(self, naps: set[str]) -> str | None:
        """Return whether to wait for a node that is starting and sleeps by the wall clock, as waits_for() does."""
        now = monotonic()
        for name in sorted(naps):
            process = self.processes.get(name)
            if not process:
                continue
            self.starting[name] = since, runs = self.starting.get(name) or (now, process.main_runs(0.0))
            if process.main_runs(SPIN) > runs:
                continue        # it sleeps again and again, as rospy.spin() does
            drives = name in self.graph.similar
            if now < since + (DRIVER_SLEEP if drives else START_SLEEP):
                return STARTING % name
            if drives:
                rospy.logwarn('%s waits by the wall clock before its first command, and the clock waits for it for at '
                              'most %g s: the end pose of the robot may depend on the speed of the machine. Expected '
                              'rospy.sleep instead of time.sleep', name, DRIVER_SLEEP)
        if self.starting:
            self.starting = {}
            self._select()
        return None

    @contextmanager
    def connecting(self, topic: str) -> Iterator[None]:
        """Connect to a publisher of a topic inside; may be called by any thread. If these are commands, wait until all
        nodes are asleep and have received the time: whether a command arrives must not depend on chance."""
        if not self.own or all(topic != each.resolved_name for each in self.commands):
            yield
            return
        permission = Permission()
        self.news.set()
        self.joining.append(permission)
        permission.wait(AWAKE_TIME)
        try:
            yield
        finally:
            self.joining.remove(permission)

    def forget(self, name: str) -> bool:
        """Stop watching a node for as long as its connection lasts; return whether commands depend on it."""
        watched = name in self.drivers or name in self.graph.needed or name == MASTER
        self.starting.pop(name, None)
        if name == MASTER or name in self.processes:
            self.forgotten[name] = self.processes[name].socket if name in self.processes else None
            self._select()
        return watched

    def is_connected(self, header: object) -> bool:
        """Return whether a connection to a publisher of commands still exists. header: the header object of the
        connection."""
        return any(connection.header is header for connection in self._connections())


MASTER, STARTING = 'the master', '%s, which is starting'


def is_complete(connection: Any) -> bool:
    """Return whether a publisher has accepted a connection. The header of a refused connection has only an error."""
    return bool(connection.header) and 'callerid' in connection.header
