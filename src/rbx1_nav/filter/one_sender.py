"""Accepts the messages of one node only: two publishers on one topic would be two robots to the filter."""
from __future__ import annotations

from math import inf
import time
from typing import Callable

import rosgraph
import rospy

from rbx1_nav.node.master import call

MESSAGE_WARN_TIME = 5.0        # s of wall time to wait for the first message before a line is logged

SENSORS = {'odom': 'odometry', 'imu_data': 'IMU messages'}      # by topic


class OneSender:
    """Accepts the messages of the first node only, until it disconnects or falls silent."""

    def __init__(self, topic: str, silence: float, warn: Callable[[str], None],
                 restart: Callable[[str], None] = lambda name: None) -> None:
        """topic: name; silence: time after which another node is accepted, s; warn(text): logs a warning;
        restart(name): called before the first message of a node is accepted."""
        self.name = topic
        self.topic = rospy.resolve_name(topic)
        self.silence = silence
        self.warn = warn
        self.restart = restart
        self.header: dict[str, str] | None = None   # the header of the connection of the accepted node
        self.heard: rospy.Time | None = None        # arrival time of its last message
        self.report_time = time.monotonic() + MESSAGE_WARN_TIME     # s of the monotonic clock; infinite after report()

    def accepts(self, header: dict[str, str], subscriber: rospy.Subscriber | None) -> bool:
        """Return whether to accept a message that just arrived on the connection with this header. subscriber: of the
        topic; None if it is just being created."""
        connections, now = subscriber.impl.connections if subscriber else [], rospy.Time.now()
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

    def report(self) -> None:
        """Log once who publishes the topic, if no message has arrived for a while."""
        if self.heard is not None or time.monotonic() < self.report_time:
            return
        try:
            publishers = dict(call(rosgraph.get_master_uri(), 'getSystemState')[0]).get(self.topic)
        except Exception:       # the master does not answer: asked again later
            return
        self.report_time = inf
        reason = (f"{self.topic} is published by {', '.join(publishers)}, but no message has arrived" if publishers else
                  f'nobody publishes {self.topic}')
        self.warn(f'Waiting for {SENSORS[self.name]}: {reason}')
