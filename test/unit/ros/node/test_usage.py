"""The usage text of a node lists just the parameters that it reads, with their defaults."""
import ast
from math import pi
import os
import re

import pytest

from rbx1_nav.create.emulator.body import BodyErrors, Quirks
from rbx1_nav.robot.description import DRIVER_KEYS, WHEEL_JOINTS
from rbx1_nav.ros.node.arguments import parameter_names

ROOT = os.path.join(os.path.dirname(__file__), '..', '..', '..', '..')
SCRIPTS = ['calibrate_angular.py', 'calibrate_linear.py', 'odom_out_and_back.py', 'timed_out_and_back.py']


def read(*path):
    with open(os.path.join(ROOT, *path), encoding='utf-8') as file:
        return file.read()


def usage(node):
    """The parameters that the usage text of a node lists, sorted."""
    return sorted(parameter_names(ast.get_docstring(ast.parse(read('nodes', node)))))


@pytest.mark.parametrize('script', SCRIPTS)
def test_the_driving_scripts(script):
    assert 'Drive(' in read('nodes', script)
    read_here = re.findall(r"(?:positive|frame|node)_param\('(\w+)', ('?[\w.]+'?)(?:, [\d., ]+)?\)",
                           read('nodes', script) + read('src', 'rbx1_nav', 'ros', 'driving', 'drive.py'))
    others = ['measured'] if 'take_measured()' in read('nodes', script) else []
    assert usage(script) == sorted([name for name, _ in read_here] + others)
    for name, default in read_here:
        listed, = re.findall(rf'~{name} .*\(default: (.*)\)', read('nodes', script))
        if default == 'None':
            continue
        assert (pi if listed == 'pi' else float(listed) if listed[0].isdigit() else listed) == (
            pi if default == 'pi' else ast.literal_eval(default)), name


def test_the_filter():
    read_there = re.findall(r"section\.\w+\('(\w+)'", read('src', 'rbx1_nav', 'ros', 'filter', 'parameters.py'))
    # the one that diagnostic_updater reads
    assert usage('ekf.py') == sorted(set(read_there) | {'diagnostic_period'})


def test_the_base():
    read_here = re.findall(r"get_param\('~(\w+)'", read('nodes', 'fake_base.py'))
    read_here += re.findall(r"section\.\w+\('(\w+)'", read('src', 'rbx1_nav', 'ros', 'base', 'simulated_clock.py'))
    read_there = re.findall(r"top\.\w+\('(\w+)'", read('src', 'rbx1_nav', 'robot', 'description.py'))
    assert usage('fake_base.py') == sorted(set(read_here) | set(read_there) | DRIVER_KEYS | {'diagnostic_period'})


def test_the_base_of_a_create():
    read_there = re.findall(r"section\.\w+\('(\w+)'", read('src', 'rbx1_nav', 'create', 'driver', 'parameters.py'))
    assert usage('turtlebot_node.py') == sorted({*read_there, *WHEEL_JOINTS, 'diagnostic_period'})


@pytest.mark.parametrize('node', ['odom_ekf.py', 'pose.py'])
def test_nodes_without_parameters(node):
    assert usage(node) == [] and 'no parameters' in read('nodes', node) and 'get_param' not in read('nodes', node)


def test_the_emulated_robot():
    source = read('nodes', 'fake_create.py')
    read_here = re.findall(r"section\.(?:get|choice|number)\('(\w+)'", source)
    assert usage('fake_create.py') == sorted(set(read_here) | set(BodyErrors._fields) | set(Quirks._fields))
    faults = read('src', 'rbx1_nav', 'ros', 'base', 'robot_faults.py')
    offered = set(re.findall(r"\('(\w+)', lambda", faults))
    text = ast.get_docstring(ast.parse(source))
    assert len(offered) == 10
    for name in offered:
        assert f'~{name}' in text
