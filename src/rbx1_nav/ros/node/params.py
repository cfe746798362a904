"""Private parameters of a node, checked as they are read."""
from __future__ import annotations

import re
import sys
from typing import Callable, TypeVar
import xmlrpc.client

import rosgraph
import rospy

from rbx1_nav.config import ConfigError, Section, YamlValue
from rbx1_nav.ros.network.master import call
from rbx1_nav.ros.node.arguments import parameter_names

POSITIVE = 1e-6, 1e6    # a parameter without a range of its own

Frame = TypeVar('Frame', str, None)


def check_before_start(name: str, check: Callable[[dict[str, YamlValue]], object]) -> None:
    """Call check(params) with the private parameters that a node of this name will have.

    To be called before the node is registered: at that moment the master ends an older node with the same name, which
    may be the base of a robot. Raises ROSException with one line if check() raises ConfigError. Nothing is checked if
    the master does not answer, or the command line sets a part of a mapping.
    """
    name = future_name(name)
    given = rospy.client.load_command_line_node_params(sys.argv)
    try:
        stored = call(rosgraph.get_master_uri(), 'getParam', name)
    except (OSError, xmlrpc.client.Error):
        return
    if any('/' in key for key in given):
        return
    try:
        check(dict(stored if isinstance(stored, dict) else {}, **given))
    except ConfigError as error:
        rospy.core.configure_logging(name)      # as init_node() would, for the line to look like any other
        raise rospy.ROSException(f'{name}/{error}') from None


def future_name(name: str) -> str:
    """The full name that a node will have after rospy.init_node(name)."""
    return rosgraph.names.resolve_name(rospy.names.get_mappings().get('__name', name), rospy.get_name())


def read_wait_timeout(name: str, usage: str) -> float | None:
    """~wait_timeout as the command line sets it, or its default in the usage text, s; None if it is not listed there.

    For a node that has no master yet. Raises ROSException with one line for an invalid value.
    """
    if 'wait_timeout' not in parameter_names(usage):
        return None
    match = re.search(r'~wait_timeout .*\(default: ([\d.]+)\)', usage)
    assert match, 'a usage text gives the default'
    default = float(match.group(1))
    given = rospy.client.load_command_line_node_params(sys.argv)
    try:
        return Section(given).number('wait_timeout', *POSITIVE, default)
    except ConfigError as error:
        raise rospy.ROSException(f'{future_name(name)}/{error}') from None


def positive_param(name: str, default: float, low: float = POSITIVE[0], high: float = POSITIVE[1]) -> float:
    """The private parameter `name`, a number from `low` to `high`. Raises ROSException with one line if it is not."""
    try:
        return Section({name: rospy.get_param(f'~{name}', default)}).number(name, low, high)
    except ConfigError as error:
        raise rospy.ROSException(f'{rospy.get_name()}/{error}') from None


def frame_param(name: str, default: Frame) -> str | Frame:
    """The private parameter `name`, a frame without a leading slash. Raises ROSException with one line if it is not.

    default: may also be None.
    """
    if not rospy.has_param(f'~{name}'):
        return default
    try:
        return Section({name: rospy.get_param(f'~{name}')}).frame(name, '')
    except ConfigError as error:
        raise rospy.ROSException(f'{rospy.get_name()}/{error}') from None
