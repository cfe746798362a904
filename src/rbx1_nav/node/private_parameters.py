"""The command line and the private parameters of a node: both are checked against the declared parameters."""
from __future__ import annotations

from contextlib import contextmanager
import os
import sys
from typing import Any, Callable, Iterator, Mapping, Sequence
import xmlrpc.client

import rosgraph
from rosgraph.names import is_legal_base_name, is_legal_name
import rospy
import yaml

from rbx1_nav.node.config import ConfigError, Section, YamlValue, close_match, show, show_name, suggestion
from rbx1_nav.node.master import call
from rbx1_nav.node.parameters import Parameter, read

EXPECTED = 'expected _parameter:=value or topic:=new_topic'
_values: dict[str, Any] = {}        # parameters of this node, once it is registered


def check_command_line(usage: str, names: Sequence[str]) -> None:
    """Print the usage and exit if the command line requests it or has unknown arguments.

    names: names of the node's parameters.
    """
    arguments = sys.argv[1:]
    if '-h' in arguments or '--help' in arguments:
        print(usage)
        sys.exit(0)
    for argument in arguments:
        problem = find_problem(argument, names)
        if problem:
            # the error comes last, just above the prompt, as with argparse
            print('%s\n\n%s: error: %s: %s' % (usage, os.path.basename(sys.argv[0]), show_name(argument), problem),
                  file=sys.stderr)
            sys.exit(2)


def find_problem(argument: str, names: Sequence[str]) -> str | None:
    """Return the problem with a command-line argument, or None. names: names of the node's parameters."""
    left, assigned, right = argument.partition(':=')
    if not assigned:
        left, _, right = argument.partition('=')
        return f"unknown argument{_suggestion(left, right, names, 0.6) or f': {EXPECTED}'}"
    if left == '__name' and not is_legal_base_name(right):
        return 'expected a name of letters, digits and _ that begins with a letter'
    if left == '__ns' and (right.startswith('~') or not is_legal_name(right)):
        return 'expected a namespace such as /robot1'
    if left.startswith('__'):       # __log and the like, for rospy
        return None
    if left.startswith('_'):
        if left[1:].split('/')[0] not in names:
            return f'unknown parameter{_suggestion(left, right, names, 0.6)}'
        return None if _is_value(right) else 'expected a value'
    # a remapping: it is a mistake only if the name is very close to the name of a parameter
    suggestion = _suggestion(left, right, names, 0.8)
    if suggestion:
        return f'this remaps a topic{suggestion}'
    return None if right and is_legal_name(right) else EXPECTED


def _suggestion(left: str, value: str, names: Sequence[str], cutoff: float) -> str:
    close = close_match(left.lstrip('-_~/').replace('-', '_'), names, cutoff)
    return close and f": did you mean _{close}:={show_name(value or 'VALUE')}?"


def _is_value(text: str) -> bool:
    """Return whether rospy can read a text as YAML and send its value to the master."""
    try:
        xmlrpc.client.dumps((yaml.safe_load(text),))
    except Exception:
        return False    # yaml raises many kinds of errors, see config.load_yaml(); integers are limited to 32 bits
    return bool(text) and ':=' not in text


def report_parameters(stored: Mapping[str, YamlValue], names: Sequence[str]) -> None:
    """Log the private parameters that have no effect, and the parameters that an earlier command left on the master.

    stored: the parameters on the master; names: names of the node's parameters.
    """
    name = rospy.get_name()
    unknown = sorted(show_name(each) + suggestion(each, names) for each in set(stored) - set(names))
    if any(argument.startswith('__log:=') for argument in sys.argv):    # by roslaunch, which sets parameters on purpose
        if unknown:
            rospy.logwarn('Ignoring unknown parameters: %s', ', '.join(unknown))
        return
    given = {argument.split(':=')[0][1:].split('/')[0] for argument in sys.argv[1:] if argument.startswith('_')}
    in_force = [f'{each} = {show_name(stored[each])}' for each in sorted(set(stored) & set(names) - given)]
    # a mapping was loaded from a file, which is also on purpose
    if in_force and not any(isinstance(value, dict) for value in stored.values()):
        rospy.logwarn('Parameters from an earlier run still apply: %s (`rosparam delete %s` clears them)',
                      ', '.join(in_force), name)
    if unknown:
        rospy.logwarn('Ignoring parameters from an earlier run: %s (`rosparam delete %s` clears them)',
                      ', '.join(unknown), name)


@contextmanager
def named_errors(name: str) -> Iterator[None]:
    """Turn a ConfigError into a ROSException that begins with the name of the node."""
    try:
        yield
    except ConfigError as error:
        raise rospy.ROSException(f'{name}/{error}') from None


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
    with named_errors(future_name(name)):
        return read(declared, Section(rospy.client.load_command_line_node_params(sys.argv))).get('wait_timeout')


def stored_params() -> dict[str, YamlValue]:
    """Return the private parameters of this node that are set on the master. Raises ROSException with one line."""
    stored = rospy.get_param(rospy.get_name(), {})
    if not isinstance(stored, dict):
        raise rospy.ROSException(f'{rospy.get_name()}: {show(stored)}: expected a mapping of parameters to values')
    return stored


def load_params(parameters: Sequence[Parameter], stored: dict[str, YamlValue]) -> None:
    """Check the private parameters of this node and keep them for param(). Raises ROSException with one line."""
    with named_errors(rospy.get_name()):
        _values.update(read(parameters, Section(stored)))


def param(name: str) -> Any:
    """Return the private parameter `name`, which was declared in init_node(), or its default if it is not set."""
    return _values[name]
