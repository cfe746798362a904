"""The bases that are running, according to the master."""
from __future__ import annotations

from rbx1_nav.node.master import Server


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
