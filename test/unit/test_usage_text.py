"""The docstring of a driving script declares its parameters, in the format of --help."""
import ast
from math import pi
import os

import pytest

from rbx1_nav.node.config import ConfigError, Section
from rbx1_nav.node.parameters import list_parameters, read, split_usage

ROOT = os.path.join(os.path.dirname(__file__), '..', '..')
LINE = '\nParameters:\n    ~speed   forward speed (m/s; 0.1 to 2; default: 0.5)\n'


def docstring(script):
    with open(os.path.join(ROOT, 'nodes', script), encoding='utf-8') as file:
        return ast.get_docstring(ast.parse(file.read()))


def defaults_of_get_param(script):
    """The defaults in the calls of rospy.get_param('~NAME', DEFAULT), by name."""
    with open(os.path.join(ROOT, 'nodes', script), encoding='utf-8') as file:
        calls = [node for node in ast.walk(ast.parse(file.read())) if isinstance(node, ast.Call)
                 and isinstance(node.func, ast.Attribute) and node.func.attr == 'get_param']
    return {ast.literal_eval(call.args[0])[1:]: pi if isinstance(call.args[1], ast.Name) else
            ast.literal_eval(call.args[1]) for call in calls}


@pytest.mark.parametrize('script', ['timed_out_and_back.py', 'odom_out_and_back.py'])
def test_what_the_scripts_declare_is_what_they_read(script):
    _, parameters = split_usage(docstring(script))
    assert read(parameters, Section({})) == defaults_of_get_param(script)


@pytest.mark.parametrize('script', ['timed_out_and_back.py', 'odom_out_and_back.py'])
def test_the_list_is_as_help_prints_it(script):
    text, parameters = split_usage(docstring(script))
    assert text.rstrip() + '\n\n' + list_parameters(parameters) == docstring(script)


def test_a_value_is_checked():
    text, parameters = split_usage('Drives.\n\nusage: drive.py' + LINE)
    assert text == 'Drives.\n\nusage: drive.py'
    assert read(parameters, Section({'speed': 2})) == {'speed': 2}
    with pytest.raises(ConfigError, match='speed: 2.5: expected a number from 0.1 to 2 in m/s'):
        read(parameters, Section({'speed': 2.5}))


def test_a_script_without_a_list():
    assert split_usage('Drives.') == ('Drives.', [])
    assert split_usage('') == ('', [])


def test_a_value_that_is_not_checked():
    _, (parameter,) = split_usage('Drives.\nParameters:\n    ~mode   forward or back (default: forward)')
    assert (parameter.name, parameter.default, parameter.read) == ('mode', 'forward', None)


@pytest.mark.parametrize('line', [
    'speed of the robot', '~speed   forward speed (m/s)', '~speed   forward speed (Hz, default=20)',
    '~speed   forward speed (m/s; default: fast)', '~speed   forward speed (m/s; low to high; default: 1)'])
def test_a_list_of_another_form_is_text(line):
    docstring = f'Drives.\nParameters:\n    {line}'
    assert split_usage(docstring) == (docstring, [])
