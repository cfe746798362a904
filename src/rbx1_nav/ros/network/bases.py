"""The bases that are running, according to the master."""
from __future__ import annotations

from typing import Any, Callable
import xmlrpc.client

import rosgraph

from rbx1_nav.ros.network.master import call, is_alive


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


def on_other_clock(simulated: bool, but: str) -> list[str]:
    """Return the names of live bases if they run in simulated time and `simulated` is false, or the other way round.

    but: the name of a base that is not listed. Returns [] without a master.
    """
    master = rosgraph.get_master_uri()
    try:
        if bool(call(master, 'hasParam', '/use_sim_time') and call(master, 'getParam', '/use_sim_time')) == simulated:
            return []
        publishers, subscribers, _ = call(master, 'getSystemState')
        odometry = [topic for topic, kind in call(master, 'getTopicTypes') if kind == 'nav_msgs/Odometry']
        names = set().union(*namespaces_of_bases(dict(publishers), dict(subscribers), odometry).values())
        return sorted(name for name in names - {but} if is_alive(name))
    except (OSError, xmlrpc.client.Error):
        return []


# Any: what a call returns depends on its method
def private_namespace(base: str, topic: str, ask: Callable[..., Any]) -> str:
    """Return the namespace of the parameters and services of a simulated robot: the name of its base, or NAME/arbotix
    if the base is a fleet. topic: of the odometry; ask(method, *args): calls the master."""
    return f"{topic.rpartition('/')[0]}/arbotix" if ask('hasParam', f'{base}/robots') else base
