"""Keeps every publisher that the master has named.

rospy connects a subscriber to the publishers in the last list that it has received, and drops a list that it has not
used yet. A publisher that registers at the same moment as the subscriber is in the master's notice, but not in the
answer to the registration of the subscriber. If the answer comes last, they are never connected.
"""
from __future__ import annotations

from typing import Sequence

from rospy.impl.registration import RegManager


def _update(manager: RegManager, topic: str, publishers: Sequence[str]) -> None:
    """Add a list of publishers (URIs) to those that rospy has not used yet. A publisher that no longer exists does not
    harm: it refuses the connection."""
    with manager.cond:
        unused = [uri for name, uris in manager.updates if name == topic for uri in uris]
        manager.updates.append((topic, [*unused, *(uri for uri in publishers if uri not in unused)]))
        manager.cond.notify_all()


def keep() -> None:
    """Keep all publishers, in this process; to be called before the node starts."""
    RegManager.publisher_update = _update
