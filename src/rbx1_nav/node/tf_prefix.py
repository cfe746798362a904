"""Names of frames with a tf_prefix, as in tf: several robots that share one /tf need different frames."""
from __future__ import annotations

import rospy

from rbx1_nav.node.config import Section, YamlValue
from rbx1_nav.node.private_parameters import named_errors


def find_prefix() -> YamlValue:
    """Return the tf_prefix of this node or of the nearest namespace around it, not checked; None if there is none."""
    name = rospy.search_param('tf_prefix')
    return rospy.get_param(name, None) if name else None


def check_prefix(value: YamlValue) -> str:
    """Return the value of tf_prefix, which may be missing or ''. Raises ConfigError."""
    return Section({'tf_prefix': value}).frame('tf_prefix', '') if value else ''


def with_prefix(prefix: str, frame: str) -> str:
    """Return the name of a frame with a prefix, which may be ''."""
    return f'{prefix}/{frame}' if prefix else frame


def resolve_frame(frame: str) -> str:
    """Return the name of a frame with the tf_prefix of this node, which may also be set in a namespace around the node.
    Raises ROSException with one line."""
    with named_errors(rospy.get_name()):
        return with_prefix(check_prefix(find_prefix()), frame)
