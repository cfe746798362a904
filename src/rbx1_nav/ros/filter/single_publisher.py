"""Listens to one of several nodes that publish the same topic."""
from __future__ import annotations

from typing import Callable, Iterable

import rospy
from rospy.impl.tcpros_base import TCPROSTransport


class OneSender:
    """Decides whose messages count: those of the first node, until it has gone or fallen silent."""

    def __init__(self, topic: str, silence: float, warn: Callable[[str], None],
                 restart: Callable[[str], None]) -> None:
        """topic: name; silence: s, after which another node may follow; warn(text): logs a warning; restart(name):
        called before the first message of a node counts."""
        self.topic = rospy.resolve_name(topic)
        self.silence = silence
        self.warn = warn
        self.restart = restart
        self.header: dict[str, str] | None = None   # the header of its connection
        self.heard: rospy.Time | None = None        # rospy.Time when its last message arrived

    def accepts(self, header: dict[str, str], connections: Iterable[TCPROSTransport], now: rospy.Time) -> bool:
        """Whether a message counts that came by the connection with this header, among rospy's present connections."""
        if self.header is not None and header is not self.header and any(
                connection.header is self.header for connection in connections) and (
                0 <= (now - self.heard).to_sec() <= self.silence):
            self.warn('%s: messages of %s ignored: %s publishes it too'
                      % (self.topic, header['callerid'], self.header['callerid']))
            return False
        if header is not self.header:
            self.restart(header['callerid'])
        self.header, self.heard = header, now
        return True
