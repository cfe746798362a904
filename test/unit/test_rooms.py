"""Which rooms of the package may import which, where ROS may be imported, and the maximum length of a file."""
import importlib.util
import os
import subprocess
import sys
import sysconfig

import pytest

ROOT = os.path.normpath(os.path.join(os.path.dirname(__file__), '..', '..'))
sys.path.insert(0, os.path.join(ROOT, 'script'))
import rooms
from rooms import imported_modules, modules, python_files

# room, a folder of rbx1_nav: the other rooms that it may import. '' is the package itself
ALLOWED = {
    '': set(), 'node': set(), 'extras': set(),
    'base': {'node'},
    'exercise': {'base'},
    'driving': {'base', 'exercise', 'node'},
    'simulation': {'base', 'node'},
    'filter': {'base', 'node'},
    'extras.create': {'base', 'node'},
    'extras.create.emulator': {'base', 'extras.create', 'node', 'simulation'},
    'extras.fitting': {'base', 'filter', 'node', 'simulation'},
    'extras.lockstep': {'base', 'node'},
    'extras.many_runs': {'base', 'exercise', 'extras.fitting', 'filter', 'node', 'simulation'},
    'extras.page': {'base', 'exercise', 'extras.many_runs', 'extras.web', 'simulation'},
    'extras.web': {'base', 'exercise', 'node'},
}
ALLOWED['nodes'] = set(ALLOWED) - {''}
# the files that need ROS; all others also run where there is none
WITH_ROS = {f'rbx1_nav.{room}.{name}' for room, names in {
    'node': 'addresses tf_prefix life master private_parameters resources rospy_connections',
    'base': 'clocks command_subscriber messages model_check publisher refusals running_bases',
    'driving': 'calibration_script base_connection odometry rate script stopping',
    'simulation': 'floor_parameters simulated_base_node',
    'filter': 'conversions ekf_parameters estimate_publisher filter_status imu_input one_sender',
    'extras.create': 'create_base create_status create_topics',
    'extras.create.emulator': 'fault_services',
    'extras.fitting': 'bags',
    'extras.lockstep': 'lockstep simulated_clock watched_nodes',
    'extras.web': 'connections controls hand_drive system',
}.items() for name in names.split()} | {'rbx1_nav.driving'}
# what the other rooms may import in addition to Python's own modules
THIRD_PARTY = {'PIL', 'matplotlib', 'numpy', 'scipy', 'serial', 'tornado', 'yaml'}
OF_MODULE = {'rbx1_nav.extras.many_runs.cluster': {'dask', 'distributed'}, 'rbx1_nav.extras.many_runs.sweep': {'tqdm'}}
MAX_NODE_LINES, MAX_LINES = 150, 300


def room_of(module):
    """The room of a module or package, as in ALLOWED."""
    return 'nodes' if module.startswith('nodes.') else rooms.folder_of(module).strip('/').replace('/', '.')


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
    room = room_of(module)
    found = []
    for name in imported_modules(source, module, is_package):
        top = name.split('.')[0]
        if top == 'rbx1_nav':
            allowed = room_of(name) in ALLOWED[room] | {room}
        else:
            known = THIRD_PARTY | OF_MODULE.get(module, set())
            allowed = top != '?' and (room == 'nodes' or module in WITH_ROS or top in known or is_standard(top))
        if not allowed:
            found.append(name)
    return found


@pytest.mark.parametrize('path, module, is_package', [pytest.param(*each, id=each[1]) for each in modules()])
def test_a_module_imports_only_what_its_room_may(path, module, is_package):
    with open(path, encoding='utf-8') as file:
        assert violations(file.read(), module, is_package) == []


def test_every_module_is_found_and_every_room_is_in_the_table():
    names = {module for _, module, _ in modules()}
    assert {'rbx1_nav', 'rbx1_nav.base.command_gate', 'nodes.fake_base'} | WITH_ROS <= names
    assert {room_of(name) for name in names} == set(ALLOWED)


def test_only_extras_import_extras():
    assert [room for room, allowed in ALLOWED.items() if room != 'nodes' and not room.startswith('extras')
            and any(each.startswith('extras') for each in allowed)] == []


def test_only_the_files_in_the_list_need_ros():
    code = ('import importlib, sys\n'
            'for name in "genpy", "rosgraph", "rospkg", "rospy":\n'
            '    sys.modules[name] = None\n'
            'for name in sys.argv[1:]:\n'
            '    try:\n'
            '        importlib.import_module(name)\n'
            '    except ImportError:\n'
            '        print(name)\n')
    names = [module for _, module, _ in modules() if module.startswith('rbx1_nav')]
    path = os.pathsep.join([rooms.SOURCE, os.environ.get('PYTHONPATH', '')])
    found = subprocess.run([sys.executable, '-c', code, *names], env={**os.environ, 'PYTHONPATH': path},
                           stdout=subprocess.PIPE, check=True, encoding='utf-8')
    assert set(found.stdout.split()) == WITH_ROS


def test_a_room_may_import_only_what_it_imports():
    """So the diagram in CONTRIBUTING.md, which is made from the imports, shows what ALLOWED permits."""
    used = {room: set() for room in ALLOWED}
    for path, module, is_package in modules():
        room = room_of(module)
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
    ('turtlebot_node', 'extras.create.serial_port',
     ('simulation', 'extras.create.emulator', 'filter', 'extras.fitting')),
    ('fake_base', 'simulation.wheels', ('extras.create', 'filter', 'extras.fitting')),
    ('ekf', 'filter.filter', ('simulation', 'extras'))])
def test_a_node_needs_nothing_of_the_others(node, needed, extra):
    found = rooms.reachable(rooms.file_arrows(), f'nodes.{node}')
    assert f'rbx1_nav.{needed}' in found
    assert [name for name in found if name.startswith(tuple(f'rbx1_nav.{room}.' for room in extra))] == []


@pytest.mark.parametrize('module, source', [
    ('rbx1_nav.simulation.wheels', 'import rospy'),
    ('rbx1_nav.extras.create.serial_port', 'from rbx1_nav.extras.create.emulator.body import Body'),
    ('rbx1_nav.extras.create.create_base', 'from rbx1_nav.simulation.wheels import Wheels'),
    ('rbx1_nav.extras.many_runs.simulated_run', 'def path():\n    import rospkg'),
    ('rbx1_nav.extras.many_runs.plots', 'name = "rospy"\n__import__(name)'),
    ('rbx1_nav.simulation.wheels', 'import importlib\nimportlib.import_module("..exercise.legs", __package__)'),
    ('rbx1_nav.filter.filter', 'from rbx1_nav.extras.many_runs.simulated_run import simulate'),
    ('rbx1_nav.node.config', 'from rbx1_nav.base.units import SECOND'),
    ('rbx1_nav.extras.many_runs.sweep', 'import distributed'),
    ('rbx1_nav.base.clocks', 'from rbx1_nav.simulation.simulated_base import make_base'),
    ('nodes.ekf', 'from rbx1_nav.no_such_room import anything'),
])
def test_an_import_that_is_not_allowed_is_found(module, source):
    assert len(violations(source, module)) == 1


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
