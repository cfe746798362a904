"""Private parameters of a node, checked as they are read."""
import re
import sys
import xmlrpc.client

import rosgraph
import rospy

from rbx1_nav.config import ConfigError, Section
from rbx1_nav.ros.network.master import call
from rbx1_nav.ros.node.arguments import parameter_names

POSITIVE = 1e-6, 1e6    # a parameter without a range of its own


def check_before_start(name, check):
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
        raise rospy.ROSException(f'{name}/{error}')


def future_name(name):
    """The full name that a node will have after rospy.init_node(name)."""
    return rosgraph.names.resolve_name(rospy.names.get_mappings().get('__name', name), rospy.get_name())


def read_wait_timeout(name, usage):
    """~wait_timeout as the command line sets it, or its default in the usage text, s; None if it is not listed there.

    For a node that has no master yet. Raises ROSException with one line for an invalid value.
    """
    if 'wait_timeout' not in parameter_names(usage):
        return None
    default = float(re.search(r'~wait_timeout .*\(default: ([\d.]+)\)', usage).group(1))
    given = rospy.client.load_command_line_node_params(sys.argv)
    try:
        return Section(given).number('wait_timeout', *POSITIVE, default)
    except ConfigError as error:
        raise rospy.ROSException(f'{future_name(name)}/{error}')


def positive_param(name, default, low=POSITIVE[0], high=POSITIVE[1]):
    """The private parameter `name`, a number from `low` to `high`. Raises ROSException with one line if it is not."""
    try:
        return Section({name: rospy.get_param(f'~{name}', default)}).number(name, low, high)
    except ConfigError as error:
        raise rospy.ROSException(f'{rospy.get_name()}/{error}')


def frame_param(name, default):
    """The private parameter `name`, a frame without a leading slash. Raises ROSException with one line if it is not.

    default: may also be None.
    """
    if not rospy.has_param(f'~{name}'):
        return default
    try:
        return Section({name: rospy.get_param(f'~{name}')}).frame(name, '')
    except ConfigError as error:
        raise rospy.ROSException(f'{rospy.get_name()}/{error}')
