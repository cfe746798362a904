"""Reports refused commands to their sender when it checks whether the base still answers.

This needs no additional topic or connection: a driving script only publishes. A base extends the slave API of its node
by one method, which returns how many commands of the caller were refused, and the reason for the last refusal.
"""
from __future__ import annotations

import xmlrpc.client

from rospy.impl.masterslave import ROSHandler

from rbx1_nav.ros.network.master import Server

METHOD = 'getRefusals'


class Refusals:
    """The refused commands of a base."""

    def __init__(self) -> None:
        # by the name of the sender: number of refused commands, and the reason for the last one
        self._refused: dict[str, tuple[int, str]] = {}
        setattr(ROSHandler, METHOD, lambda _, caller: (1, '', list(self._refused.get(caller, (0, '')))))

    @property
    def count(self) -> int:
        """Number of refused commands."""
        return sum(count for count, _ in self._refused.values())

    def add(self, sender: str, reason: str) -> None:
        """Count a refused command. sender: the name of its node; reason: a text."""
        count, _ = self._refused.get(sender, (0, ''))
        self._refused[sender] = count + 1, reason


def ask(server: Server) -> tuple[int | None, str]:
    """Return how many commands of this node another node has refused, and the reason for the last refusal; (None, '')
    if it does not report refusals. server: the Server of that node. Raises like Server.call() if it does not answer."""
    try:
        count, reason = server.call(METHOD)
        return int(count), ''.join(filter(str.isprintable, reason))
    except xmlrpc.client.Fault:
        server.call('getPid')
        return None, ''
