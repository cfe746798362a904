"""Checks and reads the private parameters of a node."""
from __future__ import annotations

import sys
from typing import Any, Callable, Sequence
import xmlrpc.client

import rosgraph
import rospy

from rbx1_nav.config import ConfigError, Section, YamlValue, show
from rbx1_nav.parameters import Parameter, read
from rbx1_nav.ros.network.master import call

_values: dict[str, Any] = {}        # parameters of this node, once it is registered


def check_before_start(name: str, parameters: Sequence[Parameter],
                       check: Callable[[dict[str, YamlValue]], object] | None = None) -> None:
    """Check the private parameters that a node of this name will have: each individually, and all with check(params).

    To be called before the node is registered, because registration shuts down an older node with the same name, which
    may be the base of a robot. Raises ROSException with one line for the first ConfigError. Nothing is checked if the
    master does not answer, or if the command line sets a part of a mapping.
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
        values = dict(stored if isinstance(stored, dict) else {}, **given)
        read(parameters, Section(values))
        if check:
            check(values)
    except ConfigError as error:
        rospy.core.configure_logging(name)      # as init_node() would, so that the line has the usual format
        raise rospy.ROSException(f'{name}/{error}') from None


def future_name(name: str) -> str:
    """Return the full name that a node will have after rospy.init_node(name)."""
    return rosgraph.names.resolve_name(rospy.names.get_mappings().get('__name', name), rospy.get_name())


def read_wait_timeout(name: str, parameters: Sequence[Parameter]) -> float | None:
    """Return ~wait_timeout from the command line, or its default, s; None if it is not one of the parameters.

    For a node that has no master yet. Raises ROSException with one line for an invalid value.
    """
    declared = [each for each in parameters if each.name == 'wait_timeout']
    try:
        values = read(declared, Section(rospy.client.load_command_line_node_params(sys.argv)))
    except ConfigError as error:
        raise rospy.ROSException(f'{future_name(name)}/{error}') from None
    return values.get('wait_timeout')


def stored_params() -> dict[str, YamlValue]:
    """Return the private parameters of this node that are set on the master. Raises ROSException with one line."""
    stored = rospy.get_param(rospy.get_name(), {})
    if not isinstance(stored, dict):
        raise rospy.ROSException(f'{rospy.get_name()}: {show(stored)}: expected a mapping of parameters to values')
    return stored


def load_params(parameters: Sequence[Parameter], stored: dict[str, YamlValue]) -> None:
    """Check the private parameters of this node and keep them for param(). Raises ROSException with one line."""
    try:
        _values.update(read(parameters, Section(stored)))
    except ConfigError as error:
        raise rospy.ROSException(f'{rospy.get_name()}/{error}') from None


def param(name: str) -> Any:
    """Return the private parameter `name`, which was declared in init_node(), or its default if it is not set."""
    return _values[name]
