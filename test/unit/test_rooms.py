"""Which rooms of the package may import which, where ROS may be imported, and the maximum length of a file."""
import importlib.util
import os
import sys
import sysconfig

import pytest

ROOT = os.path.normpath(os.path.join(os.path.dirname(__file__), '..', '..'))
sys.path.insert(0, os.path.join(ROOT, 'script'))
import rooms
from rooms import imported_modules, modules, python_files

# room (a folder or a module of rbx1_nav): the rooms that it may import in addition to itself. A module belongs to the
# innermost room that contains it
ALLOWED = {
    '__init__': set(), 'config': set(), 'create': set(), 'ros.network': set(), 'transform_utils': set(), 'units': set(),
    'files': {'config'}, 'parameters': {'config'}, 'schedule': {'units'},
    'robot': {'config', 'parameters', 'units'},
    'control': {'robot', 'units'},
    'simulation': {'config', 'robot', 'units'},
    'simulation.base': {'control', 'robot', 'simulation', 'units'},
    'simulation.exercise': {'control', 'estimation', 'robot', 'simulation.base', 'units'},
    'simulation.summary': {'robot', 'units'},
    'estimation': {'robot', 'units'},
    'fitting': {'config', 'robot', 'simulation', 'units'},
    'fitting.bags': {'config', 'estimation', 'fitting', 'robot', 'ros', 'units'},
    'plotting': {'config', 'control', 'files', 'fitting', 'robot', 'simulation.exercise', 'units'},
    'batch': {'config', 'control', 'files', 'parameters', 'robot', 'simulation.exercise', 'simulation.summary',
              'units'},
    'create.driver': {'config', 'control', 'create', 'parameters', 'robot', 'schedule', 'units'},
    'create.emulator': {'config', 'create', 'robot', 'simulation.base', 'units'},
    'ros': {'robot', 'units'},
    'ros.node': {'config', 'parameters', 'ros.network'},
    'ros.lockstep': {'ros.network', 'schedule'},
    'driving': {'config', 'control', 'parameters', 'robot', 'ros.network', 'ros.node', 'units'},
    'ros.base': {'control', 'create', 'create.driver', 'robot', 'ros', 'ros.network', 'ros.node', 'schedule', 'units'},
    'ros.base.simulated_floor': {'config', 'parameters', 'robot', 'ros.node', 'simulation'},
    'ros.base.simulated_clock': {'config', 'parameters', 'ros.base', 'ros.lockstep', 'ros.network', 'ros.node',
                                 'schedule', 'units'},
    'ros.base.simulated_robot': {'robot', 'ros', 'ros.base', 'ros.network', 'ros.node', 'schedule', 'simulation',
                                 'simulation.base'},
    'ros.base.emulated_create': {'config', 'create', 'create.emulator', 'parameters', 'ros.base.simulated_floor',
                                 'ros.node'},
    'ros.filter': {'config', 'estimation', 'parameters', 'robot', 'ros', 'ros.network', 'ros.node', 'schedule',
                   'units'},
    'ros.web': {'control', 'ros', 'ros.network', 'ros.node', 'units'},
}
ALLOWED['nodes'] = set(ALLOWED) - {'__init__'}
WITH_ROS = {room for room in ALLOWED if room.split('.')[0] == 'ros'} | {'driving', 'fitting.bags', 'nodes'}
# what the other rooms may import in addition to Python's own modules
THIRD_PARTY = {'PIL', 'matplotlib', 'numpy', 'scipy', 'serial', 'yaml'}
OF_MODULE = {'rbx1_nav.batch.cluster': {'dask', 'distributed'}, 'rbx1_nav.batch.sweep': {'tqdm'}}
MAX_NODE_LINES, MAX_LINES = 150, 300


def room_of(module):
    """The room of a module or package below rbx1_nav; its first folder if it is in no room of the table."""
    parts = module.split('.')[1:] or ['__init__']
    rooms = ['.'.join(parts[:length]) for length in range(len(parts), 0, -1)]
    return next((room for room in rooms if room in ALLOWED), parts[0])


def is_standard(module):
    """Whether a module is part of Python."""
    spec = importlib.util.find_spec(module) if module.isidentifier() else None
    if module in sys.builtin_module_names:      # of sys, Python 3.8 does not know the origin
        return True
    if spec is None or spec.origin is None:
        return False
    return spec.origin in ('built-in', 'frozen') or (
        spec.origin.startswith(sysconfig.get_path('stdlib') + os.sep) and 'site-packages' not in spec.origin)


def violations(source, module, is_package=False):
    """The imports of a module that its room does not allow. module: full name; nodes.<name> for a node."""
    room = room_of(module) if module.startswith('rbx1_nav') else 'nodes'
    found = []
    for name in imported_modules(source, module, is_package):
        top = name.split('.')[0]
        if top == 'rbx1_nav':
            allowed = room_of(name) in ALLOWED[room] | {room}
        else:
            allowed = top != '?' and (room in WITH_ROS or top in THIRD_PARTY | OF_MODULE.get(module, set())
                                      or is_standard(top))
        if not allowed:
            found.append(name)
    return found


@pytest.mark.parametrize('path, module, is_package', [pytest.param(*each, id=each[1]) for each in modules()])
def test_a_module_imports_only_what_its_room_may(path, module, is_package):
    with open(path, encoding='utf-8') as file:
        assert violations(file.read(), module, is_package) == []


def test_every_module_is_found_and_every_room_is_in_the_table():
    names = {module for _, module, _ in modules()}
    assert {'rbx1_nav', 'rbx1_nav.units', 'rbx1_nav.control.gate', 'rbx1_nav.ros.node.life', 'nodes.fake_base'} <= names
    assert {room_of(name) for name in names if name.startswith('rbx1_nav')} == set(ALLOWED) - {'nodes'}


def test_a_room_may_import_only_what_it_imports():
    """So the diagram in docs/design.md, which is made from the imports, shows what ALLOWED permits."""
    used = {room: set() for room in ALLOWED}
    for path, module, is_package in modules():
        room = room_of(module) if module.startswith('rbx1_nav') else 'nodes'
        with open(path, encoding='utf-8') as file:
            names = imported_modules(file.read(), module, is_package)
            used[room].update(room_of(name) for name in names if name.startswith('rbx1_nav'))
    unused = {room: allowed - used[room] for room, allowed in ALLOWED.items() if room != 'nodes'}
    assert {room: names for room, names in unused.items() if names} == {}


def test_the_diagram_of_the_rooms_is_up_to_date():
    with open(rooms.PAGE, encoding='utf-8') as file:
        page = file.read()
    assert rooms.DIAGRAM.search(page) and rooms.filled_in(page) == page, 'run script/rooms.py'


def test_no_rooms_and_no_files_import_each_other():
    assert rooms.circles(rooms.arrows()) == rooms.circles(rooms.file_arrows()) == []
    assert rooms.circles({('a', 'b'), ('b', 'c'), ('c', 'b'), ('c', 'd')}) == ['b', 'c']


def test_the_diagram_leaves_out_an_arrow_if_others_lead_to_the_same_room(monkeypatch):
    monkeypatch.setattr(rooms, 'arrows', lambda: {('a/', 'b/c/'), ('b/c/', 'd/'), ('a/', 'd/')})
    assert rooms.diagram().splitlines() == ['flowchart TD', '    a["a/"]', '    b_c["b/c/"]', '    d["d/"]',
                                            '    a --> b_c', '    b_c --> d']


@pytest.mark.parametrize('node, needed, extra', [
    ('turtlebot_node', 'create.driver.link', ('simulation', 'create.emulator', 'estimation', 'fitting')),
    ('fake_base', 'simulation.wheels', ('create', 'estimation', 'fitting')),
    ('ekf', 'estimation.filter', ('simulation', 'create', 'fitting'))])
def test_a_node_needs_nothing_of_the_others(node, needed, extra):
    found = rooms.reachable(rooms.file_arrows(), f'nodes.{node}')
    assert f'rbx1_nav.{needed}' in found
    assert [name for name in found if name.startswith(tuple(f'rbx1_nav.{room}' for room in extra))] == []


@pytest.mark.parametrize('module, source', [
    ('rbx1_nav.simulation.wheels', 'import rospy'),
    ('rbx1_nav.create.driver.link', 'from rbx1_nav.create.emulator.body import Body'),
    ('rbx1_nav.ros.base.create_base', 'from rbx1_nav.simulation.wheels import Wheels'),
    ('rbx1_nav.simulation.exercise', 'def path():\n    import rospkg'),
    ('rbx1_nav.plotting.plots', 'name = "rospy"\n__import__(name)'),
    ('rbx1_nav.simulation.wheels', 'from rbx1_nav.control.gate import CommandGate'),
    ('rbx1_nav.simulation.wheels', 'from ..control import gate'),
    ('rbx1_nav.simulation.wheels', 'import importlib\nimportlib.import_module("rbx1_nav.control.gate")'),
    ('rbx1_nav.simulation.wheels', 'import importlib\nimportlib.import_module("..control.gate", __package__)'),
    ('rbx1_nav.estimation.filter', 'from rbx1_nav.simulation.exercise import simulate'),
    ('rbx1_nav.units', 'from rbx1_nav.config import Section'),
    ('rbx1_nav.batch.sweep', 'import distributed'),
    ('rbx1_nav.ros.base.clocks', 'from rbx1_nav.simulation.base import make_base'),
    ('nodes.ekf', 'from rbx1_nav.no_such_room import anything'),
])
def test_an_import_that_is_not_allowed_is_found(module, source):
    assert len(violations(source, module)) == 1


@pytest.mark.parametrize('module, source', [
    ('rbx1_nav.simulation.wheels', 'from . import kinematics\nfrom .gyro import Gyro\nfrom ..units import SECOND'),
    ('rbx1_nav.simulation.wheels', 'from rbx1_nav import config, units'),
    ('rbx1_nav.estimation.filter', 'import os.path, numpy.linalg\nfrom math import pi\nimport importlib'),
    ('rbx1_nav.ros.filter.ekf_parameters', 'import rospy\nfrom rbx1_nav.ros import messages'),
    ('nodes.ekf', 'import rospy\nfrom rbx1_nav.simulation.exercise import simulate\nfrom tqdm import tqdm'),
])
def test_an_import_that_is_allowed_is_not_reported(module, source):
    assert violations(source, module) == []


@pytest.mark.parametrize('path', python_files(os.path.join(ROOT, 'nodes')), ids=os.path.basename)
def test_a_node_is_short(path):
    with open(path, encoding='utf-8') as file:
        assert len(file.readlines()) <= MAX_NODE_LINES


@pytest.mark.parametrize('folder', ['src', 'test', 'bench', 'script', 'examples'])
def test_no_file_is_long(folder):
    long = []
    for path in python_files(os.path.join(ROOT, folder)):
        with open(path, encoding='utf-8') as file:
            count = len(file.readlines())
        if count > MAX_LINES:
            long.append(f'{path}: {count} lines')
    assert not long
