"""Checks whether the base that a driving script started with still receives its commands.

A timed script cannot determine where the robot is. But it can detect that a command was lost or refused, or that the
base no longer answers. rospy would detect neither a base that hangs nor a link that is down for minutes, because the
kernel buffers tens of thousands of commands for a silent node.
"""
from __future__ import annotations

import threading
import time
from typing import Any, Mapping, NamedTuple

import rospy

from rbx1_nav.ros.network.bases import ask_refusals
from rbx1_nav.ros.network.master import Server
from rbx1_nav.ros.node.life import end_requested, sleep

# s for a base to answer a call; together with ASK_PERIOD less than 2 s. TCP retransmits after 0.2, 0.6 and 1.4 s, so a
# link failure of 0.3 s is no lost base, although the base may time out before the link is back
ANSWER_TIMEOUT = 1.4
ASK_PERIOD = 0.4        # s from an answer to the next call
STOP_TIME = 1.0         # s that a script waits after its last command


class Peer(NamedTuple):
    """A subscribed node."""

    name: str
    uri: str                # the address at which it answers calls
    is_base: bool           # whether it publishes odometry
    keeps_time: bool        # whether it publishes /clock
    refused: int | None     # number of this node's commands that it did not follow; None if it does not report this


class Listener:
    """One connection. ask() calls its node until it has a `problem`, which is a text."""

    def __init__(self, publisher: rospy.Publisher, connection: Any, peer: Peer, exact: bool) -> None:
        """connection: one of the publisher's; exact: see wait_for_subscribers()."""
        self.publisher = publisher
        self.connection = connection
        self.peer = peer
        self.exact = exact
        self.offset = publisher.impl.seq - connection.stat_num_msg
        self.answered = time.monotonic()    # s: start of the last call that the node answered
        self.problem: str | None = None

    def ask(self) -> None:
        """Call the node repeatedly."""
        server = Server(self.peer.uri, ANSWER_TIMEOUT)      # kept: a new connection costs both nodes more than the call
        while not self.problem:
            start, before = time.monotonic(), rospy.get_rostime()
            try:
                refused, reason = ask_refusals(server, self.exact)
                self.answered = start
                if refused and refused > (self.peer.refused or 0):
                    self.problem = f'did not follow a command: {reason}'
            except ConnectionRefusedError:      # the node has exited
                self.problem = 'disconnected'
            except Exception:
                if self.peer.keeps_time and rospy.get_rostime() != before:
                    self.answered = start       # a busy node whose clock advances is alive
                elif time.monotonic() - self.answered > ANSWER_TIMEOUT:
                    self.problem = 'has stopped responding'
            time.sleep(ASK_PERIOD)

    @property
    def is_connected(self) -> bool:
        """Whether the connection exists."""
        return self.connection in self.publisher.impl.connections

    def lost(self) -> int:
        """Return how many of the commands published on the topic were not sent."""
        published: int = self.publisher.impl.seq
        return published - self.offset - self.connection.stat_num_msg

    def has_all(self, last: float) -> bool:
        """Return whether the node has answered since the last command (s of the monotonic clock), and all commands have
        been sent to it if it publishes /clock."""
        return self.answered > last and not (self.peer.keeps_time and self.lost())


class Listeners:
    """All listeners of a publisher. Those that are bases are called; if there is no base, all of them are."""

    def __init__(self, publisher: rospy.Publisher, peers: Mapping[str, Peer], exact: bool) -> None:
        """peers: the Peers that are connected, by name; exact: see wait_for_subscribers()."""
        self.topic = publisher.resolved_name
        self.all = [Listener(publisher, connection, peers[connection.endpoint_id], exact)
                    for connection in publisher.impl.connections if connection.endpoint_id in peers]
        self.called = [each for each in self.all if each.peer.is_base]
        if not self.called:
            rospy.logwarn('%s: none of the subscribers (%s) publishes odometry: expected a base among them',
                          self.topic, ', '.join(sorted(peers)))
            self.called = self.all
        self.on_clock_of_base = any(peer.keeps_time for peer in peers.values())
        for each in self.called:
            threading.Thread(target=each.ask, daemon=True).start()

    def check(self) -> None:
        """Raise ROSException if a node that is called no longer accepts or follows the commands; to be called often."""
        for each in self.called:
            problem = each.problem if each.is_connected else 'disconnected'
            if problem:
                raise rospy.ROSException(f'{self.topic}: {each.peer.name} {problem}: expected it to follow the '
                                         'commands until the end of the run')

    def check_delivery(self) -> None:
        """Log which listeners were not sent all commands; to be called after the last command.

        Raises ROSException if one of them publishes /clock, and like check().
        """
        now = time.monotonic()
        last, deadline = now - STOP_TIME, now + ANSWER_TIMEOUT + ASK_PERIOD
        while time.monotonic() < deadline and not end_requested.is_set() and not all(
                each.has_all(last) for each in self.called):
            self.check()
            sleep(0.02)
        self.check()
        for each in self.all:
            lost = each.lost()
            if not each.is_connected:
                rospy.logwarn('%s: %s disconnected during the run', self.topic, each.peer.name)
            elif lost:
                text = (f'{self.topic}: {lost} of {lost + each.connection.stat_num_msg} commands to {each.peer.name} '
                        'were lost')
                if each.peer.keeps_time:
                    raise rospy.ROSException(text)
                rospy.logwarn(text)
