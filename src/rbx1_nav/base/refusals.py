"""The commands that a base has refused, or not followed exactly.

A base reports them to their sender when the sender checks whether it still answers. This needs no additional topic or
connection: a driving script only publishes. The base extends the slave API of its node by one method, which returns
how many commands of the caller were refused, and the reason for the last refusal. A script that relies on each command
also asks for those that were clamped or came too late.
"""
from __future__ import annotations

import xmlrpc.client

from rospy.impl.masterslave import ROSHandler

from rbx1_nav.node.master import Server

REFUSALS = 'getRefusals'    # method of the slave API


class Refusals:
    """The commands that a base has not followed, or not exactly."""

    def __init__(self) -> None:
        # by the name of the sender: number of commands, and the reason for the last one
        self._refused: dict[str, tuple[int, str]] = {}
        self._all: dict[str, tuple[int, str]] = {}      # also those that were clamped or came too late
        setattr(ROSHandler, REFUSALS, lambda _, caller, exact=False: (
            1, '', list((self._all if exact else self._refused).get(caller, (0, '')))))

    @property
    def count(self) -> int:
        """Number of refused commands."""
        return sum(count for count, _ in list(self._refused.values()))     # threads add to it

    def add(self, sender: str, reason: str, refused: bool = True) -> None:
        """Count a command. sender: the name of its node; reason: a text; refused: False if it was clamped or late."""
        for found in (self._refused, self._all) if refused else (self._all,):
            count, _ = found.get(sender, (0, ''))
            found[sender] = count + 1, reason


def ask_refusals(server: Server, exact: bool) -> tuple[int | None, str]:
    """Return how many commands of this node another node has not followed, and the reason for the last one; (None, '')
    if it does not report this. server: the Server of that node; exact: whether commands count that were clamped or came
    too late. Raises like Server.call() if it does not answer."""
    try:
        count, reason = server.call(REFUSALS, exact)
        return int(count), ''.join(filter(str.isprintable, reason))
    except xmlrpc.client.Fault:
        server.call('getPid')
        return None, ''
