"""The subscribers of a driving script's commands: it waits for them, because messages that are published before they
are connected are lost, and then checks whether the base still receives its commands.

A timed script cannot determine where the robot is. But it can detect that a command was lost or refused, or that the
base no longer answers. rospy would detect neither a base that hangs nor a link that is down for minutes, because the
kernel buffers tens of thousands of commands for a silent node.
"""
from __future__ import annotations

from dataclasses import dataclass, field
import socket
import threading
import time
from typing import Any, Callable

import rosgraph
import rospy

from rbx1_nav.base.refusals import ask_refusals
from rbx1_nav.base.running_bases import namespaces_of_bases
from rbx1_nav.node.life import end_requested, sleep, wait_for
from rbx1_nav.node.master import Server, call
from rbx1_nav.node.rospy_connections import connected_nodes

PERIOD = 0.1        # s between two questions to the master
# s for a base to answer a call; together with ASK_PERIOD less than 2 s. TCP retransmits after 0.2, 0.6 and 1.4 s, so a
# link failure of 0.3 s is no lost base, although the base may time out before the link is back
ANSWER_TIMEOUT = 1.4
ASK_PERIOD = 0.4        # s from an answer to the next call


@dataclass(eq=False)
class Listener:
    """A subscribed node."""

    topic: str
    name: str
    uri: str                # at which it answers calls
    is_base: bool           # whether it publishes odometry
    keeps_time: bool        # whether it publishes /clock
    refused: int            # number of this node's commands that it did not follow
    error: str = ''
    finished: bool = False      # whether the run is over
    answered: float = field(default_factory=time.monotonic)     # s: start of the last call that the node answered
    # Any: rospy has no types
    connection: Any = None      # of the publisher
    offset: int = 0             # commands that were published before it was connected

    def connect(self, publisher: rospy.Publisher) -> Listener:
        """Find the connection to the node."""
        self.publisher = publisher
        self.connection = next(each for each in publisher.impl.connections if each.endpoint_id == self.name)
        self.offset = publisher.impl.seq - self.connection.stat_num_msg
        return self

    def ask(self, exact: bool, fail: Callable[[str], object]) -> None:
        """Call the node repeatedly, until it has a problem. For the arguments, see wait_for_listeners()."""
        server = Server(self.uri, ANSWER_TIMEOUT)      # kept: a new connection costs both nodes more than the call
        while not self.finished:
            self.call(server, exact)
            if self.problem():
                break
            time.sleep(ASK_PERIOD)
        if not self.finished:
            fail(self.problem())

    def call(self, server: Server, exact: bool) -> None:
        """Call the node once."""
        start, before = time.monotonic(), rospy.get_rostime()
        try:
            refused, reason = ask_refusals(server, exact)
            self.answered = start
            if (refused or 0) > self.refused:
                self.error = f'did not follow a command: {reason}'
        except ConnectionRefusedError:      # the node has exited
            self.error = 'disconnected'
        except Exception:
            if self.keeps_time and rospy.get_rostime() != before:
                self.answered = start       # a busy node whose clock advances is alive
            elif time.monotonic() - self.answered > ANSWER_TIMEOUT:
                self.error = 'has stopped responding'

    @property
    def is_connected(self) -> bool:
        """Whether the connection exists."""
        return self.connection in self.publisher.impl.connections

    def problem(self) -> str:
        """Return why the node no longer follows the commands, or ''."""
        error = self.error if self.is_connected else 'disconnected'
        return error and (f'{self.topic}: {self.name} {error}: expected it to follow the commands until the end of the '
                          'run')

    def lost(self) -> int:
        """Return how many of the commands published on the topic were not sent."""
        published: int = self.publisher.impl.seq
        return published - self.offset - self.connection.stat_num_msg


class Listeners:
    """All listeners of a publisher. Those that are bases are called; if there is no base, all of them are."""

    def __init__(self, listeners: list[Listener], exact: bool, fail: Callable[[str], object]) -> None:
        """For the arguments, see wait_for_listeners()."""
        self.all = listeners
        self.exact = exact
        self.called = [each for each in listeners if each.is_base]
        if not self.called:
            rospy.logwarn('%s: none of the subscribers (%s) publishes odometry: expected a base among them',
                          listeners[0].topic, ', '.join(each.name for each in listeners))
            self.called = listeners
        self.on_clock_of_base = any(each.keeps_time for each in listeners)
        for each in self.called:
            threading.Thread(target=each.ask, args=(exact, fail), daemon=True).start()

    def problem(self) -> str:
        """Return why a node that is called no longer follows the commands, or ''."""
        return next(filter(None, (each.problem() for each in self.called)), '')

    def finish(self, last: float) -> None:
        """Wait until the listeners have the commands, and log which of them were not sent all. last: time of the last
        command to move, s of the monotonic clock.

        Raises ROSException if a listener that publishes /clock was not sent all, or has a problem.
        """
        deadline = time.monotonic() + ANSWER_TIMEOUT
        while time.monotonic() < deadline and not end_requested.is_set() and any(each.lost() for each in self.all):
            sleep(0.02)
        for each in self.called:
            if each.answered <= last:
                with Server(each.uri, ANSWER_TIMEOUT) as server:
                    each.call(server, self.exact)
        if self.problem():
            raise rospy.ROSException(self.problem())
        for each in self.all:
            if not each.is_connected:
                rospy.logwarn('%s: %s disconnected during the run', each.topic, each.name)
            elif each.lost():
                text = (f'{each.topic}: {each.lost()} of {each.lost() + each.connection.stat_num_msg} commands to '
                        f'{each.name} were lost')
                if each.keeps_time:
                    raise rospy.ROSException(text)
                rospy.logwarn(text)

    def release(self) -> None:
        """Stop calling the listeners."""
        for each in self.all:
            each.finished = True


class _Search:
    """Looks for the live subscribers of a topic."""

    def __init__(self, topic: str, exact: bool) -> None:
        self.topic = topic
        self.exact = exact
        self.found: dict[str, Listener] | None = None       # by name; None until the master has answered
        self.dead: set[str | None] = set()      # addresses
        self.silent: list[str] = []     # bases that may be suspended: they have not answered, but exist
        self.others: list[str] = []     # namespaces of other bases
        self.topics: list[str] = []     # other topics on which a node may receive commands
        self.next = 0.0     # s of the monotonic clock

    def update(self) -> None:
        """Ask the master and the subscribers, unless it is too early."""
        if time.monotonic() < self.next:
            return
        master = rosgraph.get_master_uri()
        try:
            publishers, subscribers, _ = [dict(each) for each in call(master, 'getSystemState')]
            kinds = dict(call(master, 'getTopicTypes'))
            odometry = [topic for topic, kind in kinds.items() if kind == 'nav_msgs/Odometry']
            namespace, commands = self.topic.rpartition('/')[::2]
            self.others = sorted(namespaces_of_bases(publishers, subscribers, odometry, commands).keys()
                                 - {namespace or '/'})
            named = {self.topic, *(f"{each.rstrip('/')}/{commands}" for each in self.others)}
            self.topics = sorted(topic for topic, names in subscribers.items()
                                 if kinds.get(topic) == 'geometry_msgs/Twist' and topic not in named
                                 and set(names) - {rospy.get_name(), *publishers.get(topic, ())})
            drivers = publishers.get(self.topic, ())     # such as the page in the browser, which also listens
            self.silent = []
            found = [self.find(master, name, any(name in publishers.get(topic, ()) for topic in odometry),
                               name in publishers.get('/clock', ())) for name in subscribers.get(self.topic, [])]
            self.found = {each.name: each for each in found if each and (each.is_base or each.name not in drivers)}
        except Exception as error:
            rospy.logwarn_throttle(5, f'The master at {master} does not answer: {error}')
        self.next = time.monotonic() + PERIOD

    def find(self, master: str, name: str, is_base: bool, keeps_time: bool) -> Listener | None:
        """Return the Listener of this name if it answers. An address that did not answer is not called again, unless a
        base may be suspended there."""
        address = None
        try:
            address = call(master, 'lookupNode', name)
            if address not in self.dead:
                with Server(address) as server:
                    return Listener(self.topic, name, address, is_base, keeps_time,
                                    ask_refusals(server, self.exact)[0] or 0)
        except Exception as error:
            if is_base and isinstance(error, socket.timeout):
                self.silent.append(name)
                return None
            self.dead.add(address)
            rospy.logwarn('%s is registered as a subscriber of %s but does not answer: ignored '
                          '(`rosnode cleanup` removes it)', name, self.topic)
        return None

    def missing(self, connected: set[str]) -> str:
        """Return what is missing. connected: names of the connected nodes."""
        if self.found is None:
            return f'the master to list the subscribers of {self.topic}'
        if self.found.keys() - connected:
            return f"{', '.join(sorted(self.found.keys() - connected))} to connect to {self.topic}"
        if self.silent:
            return f"{', '.join(self.silent)} to answer"
        if self.found:
            return 'the time on /clock'
        return f'a base that subscribes to {self.topic}{self.hint()}'

    def hint(self) -> str:
        """Return where else a base may be, or ''."""
        hint = ''
        if self.others:
            hint += (f". Bases exist in other namespaces: {', '.join(self.others)}. To drive one, set "
                     f'ROS_NAMESPACE={self.others[0]}')
        if self.topics:
            # the name in the script, which a remapping may have replaced already
            name = {new: old for old, new in rospy.names.get_resolved_mappings().items()}.get(self.topic, self.topic)
            if rospy.get_namespace() == '/':
                name = name.lstrip('/')
            hint += (f". Other Twist topics have subscribers: {', '.join(self.topics)}. To use one, add "
                     f'{name}:={self.topics[0]}')
        return hint


def wait_for_listeners(publisher: rospy.Publisher, timeout: float, exact: bool,
                       fail: Callable[[str], object]) -> Listeners:
    """Wait until all live subscribers of a publisher's topic are connected to it and simulated time has started.

    It waits for all subscribers, not only for the first, because that may be a recorder. Returns them as Listeners.
    exact: whether the script relies on each command, so that one that the base clamps, or that comes too late, is an
    error. fail(text): called in a thread if one of them no longer follows the commands.

    Raises ROSException if there is no subscriber, or one is missing, after `timeout` seconds of wall time, or if this
    node and the base are on different clocks, and ROSInterruptException as soon as shutdown is requested.
    """
    search = _Search(publisher.resolved_name, exact)

    def find() -> Listeners | None:
        search.update()
        found = list((search.found or {}).values())
        if search.silent and not any(each.is_base for each in found):
            return None
        if not (found and search.found and search.found.keys() <= connected_nodes(publisher) and rospy.get_rostime()):
            return None
        for each in found:
            if each.keeps_time and rospy.rostime.is_wallclock():
                raise rospy.ROSException('/use_sim_time was false when this node started, but '
                                         f'{each.name} publishes /clock: start this node again')
        return Listeners([each.connect(publisher) for each in found], exact, fail)
    return wait_for(find, timeout, lambda: search.missing(connected_nodes(publisher)))
