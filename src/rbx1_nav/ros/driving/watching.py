"""Whether the nodes that a driving script began with still receive its commands.

A script that drives by time cannot know where the robot is. But it can know that a command was lost or refused, or
that a node no longer takes its commands. It watches three things of each node: its connection, the bytes that its
machine has not acknowledged, and its answer to a call. rospy notices none of them for minutes, because the kernel
takes tens of thousands of commands for a node that is silent.
"""
from __future__ import annotations

import threading
import time
from typing import Any, Iterable, NamedTuple

import rosgraph
import rospy

from rbx1_nav.ros.network import refusals
from rbx1_nav.ros.network.master import Server, call
from rbx1_nav.ros.network.tcp import CLOSED_WINDOW, AcknowledgementTimer, Connection, read_connection
from rbx1_nav.ros.node.life import end_requested, sleep
from rbx1_nav.schedule import CLOCK_STEP

# s without an acknowledgement: TCP repeats after 0.2, 0.6 and 1.4 s, so 0.3 s without a link pass
LINK_TIMEOUT = 1.0
ANSWER_TIMEOUT = 1.4    # s in which a node answers a call; together with ASK_PERIOD less than 2 s
ASK_PERIOD = 0.4        # s from an answer to the next call
LOOK_PERIOD = 0.05      # s
UNREGISTER_TIME = 0.5   # s from the end of a connection to that of the registration, if a node ends as it should
STOP_TIME = 1.0         # s that a script waits after its last command
ROOM_TIMEOUT = 1.0      # s that a command waits for the one before it to be sent


class Peer(NamedTuple):
    """A node that listens."""

    name: str
    uri: str | None         # the address that it answers at; None if it does not
    essential: bool         # because it publishes odometry, as a base does
    keeps_time: bool        # whether it publishes /clock
    refused: int | None     # how many commands of this node it has refused; None if it does not tell


class Listener:
    """Watches one connection, until `problem` is a text that says what is wrong with it, or it has ended properly."""

    def __init__(self, publisher: rospy.Publisher, connection: Any, peer: Peer) -> None:
        """connection: one of the publisher's."""
        self.publisher = publisher
        self.topic = publisher.resolved_name
        self.connection = connection
        self.peer = peer
        self.offset = publisher.impl.seq - connection.stat_num_msg
        self.timer = AcknowledgementTimer()
        self.answered = 0.0     # s of the monotonic clock: when the last call began that the node answered
        self.problem: str | None = None
        self.refusal: str | None = None     # a text, if the node has not followed a command
        self.closed = False
        self.ended = False      # properly: it is no longer watched
        if peer.uri:
            threading.Thread(target=self.ask, args=(peer.uri,), daemon=True).start()

    def look(self, now: float) -> None:
        """Look at the connection. now: s of the monotonic clock."""
        if self.problem or self.closed:
            return
        state = self.read_connection()
        if not state:
            self.closed = True
            # the master may need longer than the next command may wait
            threading.Thread(target=self.find_out_why_it_closed, daemon=True).start()
        elif self.timer.silence(now, state) > LINK_TIMEOUT:
            # a node that has closed its window is alive, but does not read: a recorder may do so, a base may not
            if state.window >= CLOSED_WINDOW:
                self.fail(f'{self.peer.name} acknowledges nothing that is sent to it')
            elif self.peer.essential:
                self.fail(f'{self.peer.name}, which publishes the odometry, does not read what is sent to it')

    def read_connection(self) -> Connection | None:
        """The connection's state; None if it is closed at one end."""
        try:
            state = read_connection(self.connection.socket)
        except (OSError, AttributeError):   # at this end
            return None
        return state if state.established else None

    def fail(self, problem: str) -> None:
        """Set the problem, if there is none yet, and log it."""
        if self.problem:
            return
        self.problem = problem
        # in a thread, because a log line may block, and the script has to stop the robot first
        if not end_requested.is_set():
            threading.Thread(target=rospy.logwarn, args=('%s: %s', self.topic, problem), daemon=True).start()

    def ask(self, uri: str) -> None:
        """Call the node again and again."""
        server = Server(uri, ANSWER_TIMEOUT)    # kept: a new connection costs both nodes more than the call
        silent_since: float | None = None
        while not (self.problem or self.ended):
            start, before = time.monotonic(), rospy.get_rostime()
            try:
                refused, reason = refusals.ask(server)
            except ConnectionRefusedError:      # it has ended, and so will its connection
                return
            except Exception:
                if self.ended:
                    return
                silent_since = silent_since or start
                # a busy node whose clock goes on is alive
                if self.peer.keeps_time and rospy.get_rostime() != before:
                    silent_since = None
                elif time.monotonic() - silent_since > ANSWER_TIMEOUT:
                    self.fail(f'{self.peer.name} no longer answers')
                time.sleep(LOOK_PERIOD)
                continue
            if refused and refused > (self.peer.refused or 0):
                self.refusal = f'{self.peer.name} refused a command: {reason}'
            silent_since, self.answered = None, start
            time.sleep(ASK_PERIOD)

    def find_out_why_it_closed(self) -> None:
        """Set the problem with a connection that has closed, unless the node has ended properly and is not
        essential."""
        deadline = time.monotonic() + UNREGISTER_TIME
        while self.is_registered():
            if time.monotonic() > deadline:
                self.fail(f'{self.peer.name} has gone')
                return
            time.sleep(LOOK_PERIOD)
        if self.peer.essential:
            self.fail(f'{self.peer.name}, which publishes the odometry, has gone')
            return
        self.ended = True
        if self.publisher.impl.connections and not end_requested.is_set():
            rospy.logwarn('%s: %s has gone: the others go on', self.topic, self.peer.name)

    def is_registered(self) -> bool:
        """Whether the master lists the node as a subscriber. If the master does not answer, nobody knows: yes."""
        try:
            _, subscribers, _ = call(rosgraph.get_master_uri(), 'getSystemState', timeout=LINK_TIMEOUT)
        except Exception:
            return True
        return any(self.peer.name in nodes for topic, nodes in subscribers if topic == self.topic)

    @property
    def waiting(self) -> int:
        """Number of commands that rospy has not begun to send.

        A connection that was made while the publisher was being made has no queue: it sends at once.
        """
        return len(getattr(self.connection, '_queue', ()))

    def lost(self, published: int) -> int:
        """How many of all commands that were published on the topic were not sent."""
        return published - self.offset - self.connection.stat_num_msg

    def has_all(self, published: int, last: float) -> bool:
        """Whether there is nothing more to wait for: the node has acknowledged all commands, and has answered since the
        last one; last: s of the monotonic clock. A node that does not read is not waited for."""
        state = self.read_connection()
        if self.ended or not state:     # why it has closed is found out first
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
            rospy.logwarn('%s: no subscriber publishes odometry (%s): expected a base among them', self.topic,
                          ', '.join(sorted(by_name)))
        self.next_look = 0.0    # s of the monotonic clock
        # on simulated time, the name of the one that publishes /clock
        self.clock = None if rospy.rostime.is_wallclock() else next(
            (peer.name for peer in by_name.values() if peer.keeps_time), None)
        # s of simulated time; read now, since the master may be gone when the robot moves
        self.clock_step = rospy.get_param(f'{self.clock}/clock_step', CLOCK_STEP) if self.clock else CLOCK_STEP

    def check(self) -> None:
        """Look at all connections, if that is due; to be called at least every LOOK_PERIOD.

        Raises ROSException if one of them no longer takes or follows the commands, or if none is left.
        """
        now = time.monotonic()
        if now >= self.next_look:
            self.next_look = now + LOOK_PERIOD
            self.look(now)
        if not self.publisher.impl.connections:
            names = ', '.join(listener.peer.name for listener in self.listeners if not listener.ended)
            raise rospy.ROSException(f'{self.topic}: the last subscriber has gone ({names}): expected a base')
        for listener in self.listeners:
            if listener.refusal:
                raise rospy.ROSException(f'{self.topic}: {listener.refusal}')
            if listener.problem:
                raise rospy.ROSException(
                    f'{self.topic}: {listener.problem}: expected it to listen until the end of the run')

    def look(self, now: float) -> None:
        """Look at all connections. now: s of the monotonic clock."""
        for listener in self.listeners:
            listener.look(now)

    def wait_for_room(self) -> None:
        """Wait until the node that publishes /clock has been sent all commands: none may be lost in lockstep.

        rospy deletes the oldest command if more wait than the size of the queue. Other nodes are never waited for.
        Raises ROSException after ROOM_TIMEOUT, ROSInterruptException.
        """
        if not self.clock:
            return
        deadline = time.monotonic() + ROOM_TIMEOUT
        for listener in self.listeners:
            while listener.peer.keeps_time and listener.waiting:
                if end_requested.is_set():
                    raise rospy.ROSInterruptException('shutdown requested')
                self.check()
                if time.monotonic() > deadline:
                    raise rospy.ROSException(
                        f'{self.topic}: {listener.peer.name} took no command for {ROOM_TIMEOUT:g} s')
                time.sleep(0.001)

    def check_delivery(self) -> None:
        """To be called after the last command: logs which listener was not sent all commands.

        Raises ROSException if that is the one that publishes /clock, and as check().
        """
        published, last = self.publisher.impl.seq, time.monotonic() - STOP_TIME
        deadline = time.monotonic() + ANSWER_TIMEOUT + ASK_PERIOD
        # nobody has looked since the last command: what is not acknowledged now was not acknowledged then either
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
