"""Tells a sender of commands that its base has refused some, when it looks whether the base still answers.

That takes no topic and no connection of its own: a driving script publishes, and nothing else. A base extends the
slave API of its node by one method, which returns how many commands of the caller were refused, and why the last one
was.
"""
from __future__ import annotations

import xmlrpc.client

from rospy.impl.masterslave import ROSHandler

from rbx1_nav.ros.network.master import Server

METHOD = 'getRefusals'


class Refusals:
    """Of a base."""

    def __init__(self) -> None:
        # by the name of the sender: how many commands, and why the last one
        self._refused: dict[str, tuple[int, str]] = {}
        setattr(ROSHandler, METHOD, lambda _, caller: (1, '', list(self._refused.get(caller, (0, '')))))

    @property
    def count(self) -> int:
        """How many commands were refused."""
        return sum(count for count, _ in self._refused.values())

    def add(self, sender: str, reason: str) -> None:
        """Refuse a command. sender: the name of its node; reason: a text."""
        count, _ = self._refused.get(sender, (0, ''))
        self._refused[sender] = count + 1, reason


def ask(server: Server) -> tuple[int | None, str]:
    """How many commands of this node another one has refused, and the reason for the last one; (None, '') if that node
    does not report refusals. server: the Server of that node. Raises as Server.call() if it does not answer."""
    try:
        count, reason = server.call(METHOD)
        return int(count), ''.join(filter(str.isprintable, reason))
    except xmlrpc.client.Fault:
        server.call('getPid')
        return None, ''
