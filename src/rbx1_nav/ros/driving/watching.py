"""Checks whether the nodes that a driving script started with still receive its commands.

A timed script cannot determine where the robot is. But it can detect that a command was lost or refused, or that a node
no longer accepts its commands. It monitors three things per node: its connection, the bytes that its machine has not
acknowledged, and its answer to a call. rospy would detect none of these failures for minutes, because the kernel
buffers tens of thousands of commands for a silent node.
"""
from __future__ import annotations

import threading
import time
from typing import Any, Iterable, NamedTuple

import rosgraph
import rospy

from rbx1_nav.ros.network.bases import ask_refusals
from rbx1_nav.ros.network.master import Server, call
from rbx1_nav.ros.network.tcp import CLOSED_WINDOW, AcknowledgementTimer, Connection, read_connection
from rbx1_nav.ros.node.life import end_requested, sleep
from rbx1_nav.schedule import CLOCK_STEP

# s without an acknowledgment: TCP retransmits after 0.2, 0.6 and 1.4 s, so a link failure of 0.3 s is tolerated
LINK_TIMEOUT = 1.0
ANSWER_TIMEOUT = 1.4    # s for a node to answer a call; together with ASK_PERIOD less than 2 s
ASK_PERIOD = 0.4        # s from an answer to the next call
LOOK_PERIOD = 0.05      # s
UNREGISTER_TIME = 0.5   # s from the end of a connection to the end of the registration, if a node exits properly
STOP_TIME = 1.0         # s that a script waits after its last command


class Peer(NamedTuple):
    """A subscribed node."""

    name: str
    uri: str | None         # the address at which it answers calls; None if it does not answer
    essential: bool         # whether it publishes odometry, as a base does
    keeps_time: bool        # whether it publishes /clock
    refused: int | None     # number of refused commands of this node; None if it does not report refusals


class Listener:
    """Watches one connection until it has a `problem`, which is a text, or the node has exited properly."""

    def __init__(self, publisher: rospy.Publisher, connection: Any, peer: Peer) -> None:
        """connection: one of the publisher's."""
        self.publisher = publisher
        self.topic = publisher.resolved_name
        self.connection = connection
        self.peer = peer
        self.offset = publisher.impl.seq - connection.stat_num_msg
        self.timer = AcknowledgementTimer()
        self.answered = 0.0     # s of the monotonic clock: start of the last call that the node answered
        self.problem: str | None = None
        self.refusal: str | None = None     # a text, if the node has refused a command
        self.closed = False
        self.ended = False      # whether the node has exited properly and is no longer watched

    def start(self) -> None:
        """Call the node from now on, if it answers calls."""
        if self.peer.uri:
            threading.Thread(target=self.ask, args=(self.peer.uri,), daemon=True).start()

    def look(self, now: float) -> None:
        """Look at the connection. now: s of the monotonic clock."""
        if self.problem or self.closed:
            return
        state = self.read_connection()
        if not state:
            self.closed = True
            # in a thread, because the master may take longer to answer than the next command can wait
            threading.Thread(target=self.find_out_why_it_closed, daemon=True).start()
        elif self.timer.silence(now, state) > LINK_TIMEOUT:
            # a node with a closed window is alive but does not read; that is allowed for a recorder, not for a base
            if state.window >= CLOSED_WINDOW:
                self.fail(f'{self.peer.name} does not acknowledge any data')
            elif self.peer.essential:
                self.fail(f'{self.peer.name}, which publishes the odometry, does not read its commands')

    def read_connection(self) -> Connection | None:
        """Return the state of the connection; None if either side has closed it."""
        try:
            state = read_connection(self.connection.socket)
        except (OSError, AttributeError):   # closed by this node
            return None
        return state if state.established else None

    def fail(self, problem: str) -> None:
        """Set the problem and log it, unless there is one already."""
        if self.problem:
            return
        self.problem = problem
        # in a thread, because logging may block, and the script has to stop the robot first
        if not end_requested.is_set():
            threading.Thread(target=rospy.logwarn, args=('%s: %s', self.topic, problem), daemon=True).start()

    def ask(self, uri: str) -> None:
        """Call the node repeatedly."""
        server = Server(uri, ANSWER_TIMEOUT)    # kept: a new connection costs both nodes more than the call
        silent_since: float | None = None
        while not (self.problem or self.ended):
            start, before = time.monotonic(), rospy.get_rostime()
            try:
                refused, reason = ask_refusals(server)
            except ConnectionRefusedError:      # the node has exited, and its connection will close
                return
            except Exception:
                if self.ended:
                    return
                silent_since = silent_since or start
                # a busy node whose clock advances is alive
                if self.peer.keeps_time and rospy.get_rostime() != before:
                    silent_since = None
                elif time.monotonic() - silent_since > ANSWER_TIMEOUT:
                    self.fail(f'{self.peer.name} has stopped responding')
                time.sleep(LOOK_PERIOD)
                continue
            if refused and refused > (self.peer.refused or 0):
                self.refusal = f'{self.peer.name} refused a command: {reason}'
            silent_since, self.answered = None, start
            time.sleep(ASK_PERIOD)

    def find_out_why_it_closed(self) -> None:
        """Set the problem of a closed connection, unless the node has exited properly and is not essential."""
        deadline = time.monotonic() + UNREGISTER_TIME
        while self.is_registered():
            if time.monotonic() > deadline:
                self.fail(f'{self.peer.name} disconnected')
                return
            time.sleep(LOOK_PERIOD)
        if self.peer.essential:
            self.fail(f'{self.peer.name}, which publishes the odometry, disconnected')
            return
        self.ended = True
        if self.publisher.impl.connections and not end_requested.is_set():
            rospy.logwarn('%s: %s disconnected; continuing with the other subscribers', self.topic, self.peer.name)

    def is_registered(self) -> bool:
        """Return whether the master lists the node as a subscriber; True if the master does not answer."""
        try:
            _, subscribers, _ = call(rosgraph.get_master_uri(), 'getSystemState', timeout=LINK_TIMEOUT)
        except Exception:
            return True
        return any(self.peer.name in nodes for topic, nodes in subscribers if topic == self.topic)

    def lost(self, published: int) -> int:
        """Return how many of the commands published on the topic were not sent."""
        return published - self.offset - self.connection.stat_num_msg

    def has_all(self, published: int, last: float) -> bool:
        """Return whether the node has acknowledged all commands, and has answered since the last one.

        last: s of the monotonic clock. A node that does not read its commands is not waited for.
        """
        state = self.read_connection()
        if self.ended or not state:     # first, find_out_why_it_closed() must finish
            return self.ended
        return (state.window < CLOSED_WINDOW
                or (not state.unacknowledged and (self.answered > last or not self.peer.uri)
                    and not (self.peer.keeps_time and self.lost(published))))


class Listeners:
    """All listeners of a publisher."""

    def __init__(self, publisher: rospy.Publisher, peers: Iterable[Peer]) -> None:
        """peers: the Peers that are connected."""
        self.publisher = publisher
        self.topic = publisher.resolved_name
        by_name = {peer.name: peer for peer in peers}
        self.listeners = [Listener(publisher, connection, by_name[connection.endpoint_id])
                          for connection in publisher.impl.connections if connection.endpoint_id in by_name]
        if not any(peer.essential for peer in by_name.values()):
            rospy.logwarn('%s: none of the subscribers (%s) publishes odometry: expected a base among them',
                          self.topic, ', '.join(sorted(by_name)))
        self.next_look = 0.0    # s of the monotonic clock
        # on simulated time, the name of the node that publishes /clock
        self.clock = None if rospy.rostime.is_wallclock() else next(
            (peer.name for peer in by_name.values() if peer.keeps_time), None)
        # s of simulated time; read now, since the master may have died when the robot moves
        self.clock_step = rospy.get_param(f'{self.clock}/clock_step', CLOCK_STEP) if self.clock else CLOCK_STEP

    def start(self) -> None:
        """Call the nodes from now on."""
        for listener in self.listeners:
            listener.start()

    def check(self) -> None:
        """Look at all connections, if that is due; to be called at least every LOOK_PERIOD.

        Raises ROSException if a node no longer accepts or follows the commands, or if no node is left.
        """
        now = time.monotonic()
        if now >= self.next_look:
            self.next_look = now + LOOK_PERIOD
            self.look(now)
        if not self.publisher.impl.connections:
            names = ', '.join(listener.peer.name for listener in self.listeners if not listener.ended)
            raise rospy.ROSException(f'{self.topic}: {names} disconnected, and no subscriber is left: expected a base')
        for listener in self.listeners:
            if listener.refusal:
                raise rospy.ROSException(f'{self.topic}: {listener.refusal}')
            if listener.problem:
                raise rospy.ROSException(
                    f'{self.topic}: {listener.problem}: expected it to receive commands until the end of the run')

    def look(self, now: float) -> None:
        """Look at all connections. now: s of the monotonic clock."""
        for listener in self.listeners:
            listener.look(now)

    def check_delivery(self) -> None:
        """Log which listeners were not sent all commands; to be called after the last command.

        Raises ROSException if one of them publishes /clock, and like check().
        """
        published, last = self.publisher.impl.seq, time.monotonic() - STOP_TIME
        deadline = time.monotonic() + ANSWER_TIMEOUT + ASK_PERIOD
        # no check since the last command: data not acknowledged now was not acknowledged then either
        self.look(last)
        while time.monotonic() < deadline and not end_requested.is_set() and not all(
                each.has_all(published, last) for each in self.listeners):
            self.check()
            sleep(0.02)
        self.check()
        for listener in self.listeners:
            lost = listener.lost(published)
            if lost and listener.connection in self.publisher.impl.connections:
                text = (f'{self.topic}: {lost} of {published - listener.offset} commands to {listener.peer.name} '
                        'were lost')
                if listener.peer.keeps_time:
                    raise rospy.ROSException(text)
                rospy.logwarn(text)
