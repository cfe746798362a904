"""Names of frames with a tf_prefix, as in tf: several robots that share one /tf need different frames."""
from __future__ import annotations

from typing import Any, Callable

import rosgraph
import rospy

from rbx1_nav.config import Section, YamlValue
from rbx1_nav.ros.node.params import named_errors


# Any: the type depends on the parameter
def search_value(key: str, node: str, get: Callable[[str, None], Any]) -> Any:
    """Return the value of a parameter of a node or of the nearest namespace around it; None if there is none.

    get: rospy.get_param.
    """
    while node:
        value = get(rosgraph.names.ns_join(node, key), None)
        if value is not None:
            return value
        node = '' if node == '/' else rosgraph.names.namespace(node).rstrip('/') or '/'
    return None


def check_prefix(value: YamlValue) -> str:
    """Return the value of tf_prefix, which may be missing or ''. Raises ConfigError."""
    return Section({'tf_prefix': value}).frame('tf_prefix', '') if value else ''


def with_prefix(prefix: str, frame: str) -> str:
    """Return the name of a frame with a prefix, which may be ''."""
    return f'{prefix}/{frame}' if prefix else frame


def resolve_frame(frame: str) -> str:
    """Return the name of a frame with the tf_prefix of this node, which may also be set in a namespace around the node.
    Raises ROSException with one line."""
    prefix = search_value('tf_prefix', rospy.get_name(), rospy.get_param)
    with named_errors(rospy.get_name()):
        return with_prefix(check_prefix(prefix), frame)
