"""The bases that are running, according to the master, and the commands that a base has refused.

A base reports refused commands to their sender when the sender checks whether it still answers. This needs no
additional topic or connection: a driving script only publishes. The base extends the slave API of its node by one
method, which returns how many commands of the caller were refused, and the reason for the last refusal.
"""
from __future__ import annotations

import xmlrpc.client

from rospy.impl.masterslave import ROSHandler

from rbx1_nav.ros.network.master import Server

REFUSALS = 'getRefusals'    # method of the slave API


def namespaces_of_bases(publishers: dict[str, list[str]], subscribers: dict[str, list[str]], odometry: list[str],
                        commands: str = 'cmd_vel') -> dict[str, set[str]]:
    """Return the names of the bases by the namespace of their commands. A base publishes odometry.

    publishers, subscribers: names of nodes by topic; odometry: topics of this type; commands: last part of the name of
    the topic.
    """
    with_odometry = {name for topic in odometry for name in publishers.get(topic, ())}
    found = {topic.rpartition('/')[0] or '/': with_odometry.intersection(names)
             for topic, names in subscribers.items() if topic.endswith(f'/{commands}')}
    return {namespace: names for namespace, names in found.items() if names}


def private_namespace(base: str, topic: str, master: Server) -> str:
    """Return the namespace of the parameters and services of a simulated robot: the name of its base, or NAME/arbotix
    if the base is a fleet. topic: of the odometry."""
    return f"{topic.rpartition('/')[0]}/arbotix" if master.call('hasParam', f'{base}/robots') else base


class Refusals:
    """The refused commands of a base."""

    def __init__(self) -> None:
        # by the name of the sender: number of refused commands, and the reason for the last one
        self._refused: dict[str, tuple[int, str]] = {}
        setattr(ROSHandler, REFUSALS, lambda _, caller: (1, '', list(self._refused.get(caller, (0, '')))))

    @property
    def count(self) -> int:
        """Number of refused commands."""
        return sum(count for count, _ in list(self._refused.values()))     # threads add to it

    def add(self, sender: str, reason: str) -> None:
        """Count a refused command. sender: the name of its node; reason: a text."""
        count, _ = self._refused.get(sender, (0, ''))
        self._refused[sender] = count + 1, reason


def ask_refusals(server: Server) -> tuple[int | None, str]:
    """Return how many commands of this node another node has refused, and the reason for the last refusal; (None, '')
    if it does not report refusals. server: the Server of that node. Raises like Server.call() if it does not answer."""
    try:
        count, reason = server.call(REFUSALS)
        return int(count), ''.join(filter(str.isprintable, reason))
    except xmlrpc.client.Fault:
        server.call('getPid')
        return None, ''
