"""Selects one of several nodes that publish the same topic."""
from __future__ import annotations

from typing import Callable, Iterable

import rospy
from rospy.impl.tcpros_base import TCPROSTransport


class OneSender:
    """Accepts the messages of the first node only, until it disconnects or falls silent."""

    def __init__(self, topic: str, silence: float, warn: Callable[[str], None],
                 restart: Callable[[str], None]) -> None:
        """topic: name; silence: time after which another node is accepted, s; warn(text): logs a warning;
        restart(name): called before the first message of a node is accepted."""
        self.topic = rospy.resolve_name(topic)
        self.silence = silence
        self.warn = warn
        self.restart = restart
        self.header: dict[str, str] | None = None   # the header of the connection of the accepted node
        self.heard: rospy.Time | None = None        # arrival time of its last message

    def accepts(self, header: dict[str, str], connections: Iterable[TCPROSTransport], now: rospy.Time) -> bool:
        """Return whether to accept a message that arrived on the connection with this header. connections: rospy's
        current connections."""
        if self.header is not None and header is not self.header and any(
                connection.header is self.header for connection in connections) and (
                0 <= (now - self.heard).to_sec() <= self.silence):
            self.warn('%s: messages from %s ignored: %s also publishes this topic'
                      % (self.topic, header['callerid'], self.header['callerid']))
            return False
        if header is not self.header:
            self.restart(header['callerid'])
        self.header, self.heard = header, now
        return True
