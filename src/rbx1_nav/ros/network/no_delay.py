"""Sends messages at once to every subscriber."""
from __future__ import annotations

import socket
from typing import Any, Callable

import rospy
from rospy.topics import get_topic_manager


class NoDelay(rospy.SubscribeListener):
    """Sets TCP_NODELAY for each subscriber of a publisher.

    rospy does this only if the subscriber asks for it. Without it, messages may arrive in bursts of 30 to 60 ms.
    """

    # Any: rospy has no types
    def __init__(self, greet: Callable[[str, Callable[[Any], None]], None] | None = None) -> None:
        """greet(topic, publish): sends messages to a new subscriber."""
        self.greet = greet

    def peer_subscribe(self, topic_name: str, _: Any, peer_publish: Callable[[Any], None]) -> None:
        for connection in get_topic_manager().get_publisher_impl(topic_name).connections:
            try:
                connection.socket.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
            except (AttributeError, OSError):       # closed
                pass
        if self.greet:
            self.greet(topic_name, peer_publish)
