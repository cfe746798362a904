"""The command line and the private parameters of a node, checked against its usage text.

A usage text lists the node's parameters, each on a line of its own that begins with `~` and the name; more names may
follow after commas.
"""
import difflib
import re
import sys

import rospy


def parameter_names(usage):
    """The names of the parameters that a usage text lists."""
    lines = [line for line in usage.splitlines() if line.lstrip().startswith('~')]
    return [name for line in lines for name in re.findall(r'~(\w+)', line)]


def check_command_line(usage):
    """Print the usage and exit if the command line asks for it, or has arguments that this node does not know."""
    arguments = sys.argv[1:]
    if '-h' in arguments or '--help' in arguments:
        print(usage.strip())
        sys.exit(0)
    problem = next(filter(None, (_problem(each, parameter_names(usage)) for each in arguments)), None)
    if problem:
        print('%s\n\n%s' % (problem, usage.strip()), file=sys.stderr)
        sys.exit(2)


def _problem(argument, names):
    """What is wrong with an argument, or None."""
    left, assigned, value = argument.partition(':=')
    if not assigned:
        return '%s: unknown argument: expected none but _parameter:=value and name:=new_name' % argument
    if left.startswith('__'):
        return None
    if left.startswith('_'):
        if left[1:].split('/')[0] in names:
            return None
        close = difflib.get_close_matches(left[1:], names, 1)
        return '%s: unknown parameter%s' % (argument, ': did you mean _%s:=%s?' % (close[0], value) if close else '')
    if left.lstrip('~/') in names:
        return '%s is a remapping, not a parameter: write _%s:=%s' % (argument, left.lstrip('~/'), value)
    return None


def report_parameters(usage):
    """Log the private parameters that have no effect, and those that an earlier run left on the parameter server."""
    name, names = rospy.get_name(), parameter_names(usage)
    stored = rospy.get_param(name, {})
    if not isinstance(stored, dict):
        return
    unknown = sorted(set(map(str, stored)) - set(names))
    if unknown:
        rospy.logwarn('Unknown parameters, without effect: %s (`rosparam delete %s` removes all)',
                      ', '.join('%s/%s' % (name, each) for each in unknown), name)
    # roslaunch sets parameters on purpose, and starts its nodes with __log
    if any(each.startswith('__log:=') for each in sys.argv):
        return
    given = {each.split(':=')[0][1:] for each in sys.argv if each.startswith('_')}
    remembered = sorted(set(stored) & set(names) - given)
    if remembered:
        rospy.logwarn('Set by an earlier command and still in force: %s (`rosparam delete %s` removes all)',
                      ', '.join('%s = %s' % (each, stored[each]) for each in remembered), name)
