#!/usr/bin/env python3
"""Change the package at random places, and check whether the unit tests of the room fail. See bench/README.md."""
import argparse
import ast
from collections import namedtuple
from concurrent.futures import ThreadPoolExecutor
from contextlib import contextmanager
import glob
import os
import random
import shutil
import signal
import subprocess
import sys
import tempfile
import threading
import time

ROOT = os.path.realpath(os.path.join(os.path.dirname(__file__), '..'))
SOURCE = os.path.join('src', 'rbx1_nav')
sys.path.insert(0, os.path.join(ROOT, 'script'))
from rooms import arrows

ROOMS = 'base', 'driving', 'exercise', 'filter', 'node', 'simulation', 'extras/create', 'nodes'
SLOWER = 5      # tests that take this many times as long as without a mutation, and START more, hang: they have failed
START = 30      # s
TUNING = os.path.join(os.path.dirname(os.path.realpath(__file__)), 'tuning.txt')

OTHER = {
    ast.Add: ast.Sub, ast.Sub: ast.Add, ast.Mult: ast.Div, ast.Div: ast.Mult, ast.Pow: ast.Mult, ast.FloorDiv: ast.Mult,
    ast.Mod: ast.Add, ast.LShift: ast.RShift, ast.BitAnd: ast.BitOr, ast.BitOr: ast.BitAnd, ast.And: ast.Or,
    ast.Or: ast.And, ast.Lt: ast.LtE, ast.LtE: ast.Lt, ast.Gt: ast.GtE, ast.GtE: ast.Gt, ast.Eq: ast.NotEq,
    ast.NotEq: ast.Eq, ast.Is: ast.IsNot, ast.IsNot: ast.Is, ast.In: ast.NotIn, ast.NotIn: ast.In}
STATEMENTS = ast.Assign, ast.AugAssign, ast.Expr, ast.Raise, ast.Delete

RUNNING = set()     # processes of tests
STOPPING = threading.Event()

Mutation = namedtuple('Mutation', 'path line what source')
Mutation.__doc__ = 'A changed file: path, line, description of the change, and the complete source.'


def is_number(node):
    """Whether a node is a number."""
    return isinstance(node, ast.Constant) and type(node.value) in (int, float)


def is_statement(node):
    """Whether a node is a statement that can be removed; docstrings and hints have no effect."""
    return isinstance(node, STATEMENTS) and not (isinstance(node, ast.Expr) and isinstance(node.value, ast.Constant))


def read_tuning():
    """The names of the constants that are tuning: {room: names}; names that a line assigns together are one."""
    found = {}
    with open(TUNING, encoding='utf-8') as file:
        for line in file:
            if not line.startswith('#'):
                room, names, _ = line.split(': ', 2)
                found.setdefault(room, set()).update(names.split())
    return found


def constant(node):
    """The name of the constant that a node assigns, several joined by commas, or None."""
    if not isinstance(node, ast.Assign):
        return None
    return ','.join(each.id for each in ast.walk(node.targets[0]) if isinstance(each, ast.Name))


def walk(node, tuning):
    """A node and all nodes below it, except hints and their types, which have no effect, and constants that are
    tuning."""
    yield node
    for name, value in ast.iter_fields(node):
        if name not in ('annotation', 'returns'):
            for child in value if isinstance(value, list) else [value]:
                if isinstance(child, ast.AST) and not (isinstance(node, ast.Module) and is_left_alone(child, tuning)):
                    yield from walk(child, tuning)


def is_left_alone(node, tuning):
    """Whether a node of a module assigns one of these constants, or a type such as Tuple[float, float] for hints."""
    return constant(node) in tuning or isinstance(node, ast.Assign) and isinstance(node.value, ast.Subscript)


def places(tree, tuning):
    """All (node, index of its operator) that can be changed."""
    for node in walk(tree, tuning):
        if isinstance(node, ast.Compare):
            yield from ((node, index) for index, operator in enumerate(node.ops) if type(operator) in OTHER)
        elif isinstance(node, (ast.BinOp, ast.BoolOp, ast.AugAssign)) and type(node.op) in OTHER:
            yield node, 0
        if is_number(node) or is_statement(node):
            yield node, None


def change(tree, node, index):
    """Change a place of a tree; returns a description of the change."""
    before = ast.unparse(node)
    if index is not None:
        operators = node.ops if isinstance(node, ast.Compare) else [node.op]
        operators[index] = OTHER[type(operators[index])]()
        if not isinstance(node, ast.Compare):
            node.op = operators[0]
    elif is_number(node):
        node.value = node.value + 1 if isinstance(node.value, int) else node.value * 1.5 or 0.1
    else:
        for parent in ast.walk(tree):
            for field in 'body', 'orelse', 'finalbody':
                block = getattr(parent, field, None)
                if isinstance(block, list) and node in block:
                    block[block.index(node)] = ast.Pass()
        return f'without `{before}`'
    return f'`{before}` becomes `{ast.unparse(node)}`'


def parse(path):
    """The tree of a file of the package."""
    with open(os.path.join(ROOT, path), encoding='utf-8') as file:
        return ast.parse(file.read())


def files_of(rooms):
    """The paths of the modules of rooms."""
    return sorted(os.path.relpath(path, ROOT) for room in rooms
                  for path in glob.glob(os.path.join(folder_of(room), '**', '*.py'), recursive=True)
                  if os.path.basename(path) != '__init__.py')


def folder_of(room):
    """The folder of a room."""
    return os.path.join(ROOT, room if room == 'nodes' else os.path.join(SOURCE, room))


def unknown_tuning():
    """The (room, name) of the list that the package does not have."""
    return [(room, name) for room, names in read_tuning().items()
            for name in sorted(names - {constant(node) for path in files_of([room]) for node in parse(path).body})]


def draw(paths, generator, tuning):
    """A random Mutation of one of the files; all places are equally probable."""
    counts = [sum(1 for _ in places(parse(path), tuning.get(room_of(path), ()))) for path in paths]
    path, = generator.choices(paths, counts)
    tree = parse(path)
    node, index = generator.choice(list(places(tree, tuning.get(room_of(path), ()))))
    line = node.lineno
    return Mutation(path, line, change(tree, node, index), ast.unparse(tree))


def is_noticed(mutation, limits):
    """Whether the unit tests of the room, or of those that use it, fail with a Mutation. limits: {folder of tests:
    seconds after which they hang}."""
    room = room_of(mutation.path)
    with copied_package() as folder:
        with open(os.path.join(folder, mutation.path), 'w', encoding='utf-8') as file:
            file.write(mutation.source)
        # the tests that are named after the module first: most mutations make one of them fail
        module = os.path.splitext(os.path.basename(mutation.path))[0]
        named = sorted(glob.glob(os.path.join(ROOT, 'test', 'unit', room, '**', f'test_*{module}*.py'), recursive=True))
        return any(fails(folder, tests, limits[name]) for name, tests in (
            (room, [os.path.relpath(each, ROOT) for each in named]),
            *((each, [f'test/unit/{each}']) for each in tests_of(room))) if tests)


@contextmanager
def copied_package():
    """A folder with the package; its src, test and nodes are copies."""
    with tempfile.TemporaryDirectory() as folder:
        for name in os.listdir(ROOT):
            if name in ('src', 'test', 'nodes'):    # the tests find the package next to their own folder
                shutil.copytree(os.path.join(ROOT, name), os.path.join(folder, name))
            elif not name.startswith('.'):
                os.symlink(os.path.join(ROOT, name), os.path.join(folder, name))
        yield folder


def tests_of(room):
    """The folders of the unit tests that may notice a change of a room: of the room, of those that import it, and the
    tests that compare it with the documents. These also compare the comments of the nodes, which a changed file does
    not have."""
    users = {user.strip('/') for user, used in arrows() if used.strip('/') == room}
    pages = () if room == 'nodes' else ('pages',)
    return (room, *sorted(user for user in users if user in rooms_with_tests()), *pages)


def fails(folder, tests, limit=None):
    """Whether unit tests in a copy of the package fail, or take longer than `limit` seconds."""
    if STOPPING.is_set():
        return True
    process = subprocess.Popen(['/usr/bin/python3', '-m', 'pytest', '-q', '-x', '-p', 'no:cacheprovider', *tests],
                               cwd=folder, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    RUNNING.add(process)
    try:
        return process.wait(limit) != 0
    except subprocess.TimeoutExpired:
        process.kill()
        return process.wait() != 0
    finally:
        RUNNING.remove(process)


def stop(number, _):
    """End all tests, and this program, on a signal."""
    STOPPING.set()
    for process in list(RUNNING):
        process.kill()
    sys.exit(128 + number)


def rooms_with_tests():
    """The names of all rooms with a folder in test/unit."""
    tests = os.path.join(ROOT, 'test', 'unit')
    names = [os.path.relpath(folder, tests) for folder, _, files in os.walk(tests) if files]
    return sorted(name for name in names if os.path.isdir(folder_of(name)))


def room_of(path):
    """The innermost room with tests that a file of the package belongs to."""
    return max((room for room in rooms_with_tests()
                if os.path.join(ROOT, path).startswith(folder_of(room) + os.sep)), key=len)


def duration(name):
    """The time in seconds that the unit tests in a folder take without a mutation. Exits if they fail."""
    begin = time.monotonic()
    with copied_package() as folder:
        failed = fails(folder, [f'test/unit/{name}'])
    if failed:
        sys.exit(f'test/unit/{name} fails without a mutation')
    took = time.monotonic() - begin
    print(f'test/unit/{name}: {took:.0f} s without a mutation', flush=True)
    return took


def main():
    """Draw, test and print. Returns the exit status."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument('rooms', nargs='*', default=ROOMS, metavar='ROOM', help=f"default: {' '.join(ROOMS)}")
    parser.add_argument('--count', type=int, default=100, metavar='N', help='number of mutations; default: 100')
    parser.add_argument('--seed', type=int, default=0, help='default: 0')
    parser.add_argument('--jobs', type=int, default=1, metavar='N', help='mutations in parallel; default: 1')
    arguments = parser.parse_args()
    for name in 'count', 'jobs':
        if getattr(arguments, name) < 1:
            parser.error(f'--{name}: {getattr(arguments, name)}: expected a number from 1')
    for room in arguments.rooms:
        if room not in rooms_with_tests():
            parser.error(f"{room}: no such room: expected one of {', '.join(rooms_with_tests())}")
    for number in signal.SIGINT, signal.SIGTERM:
        signal.signal(number, stop)
    paths = files_of(arguments.rooms)
    tuning = read_tuning()
    generator = random.Random(arguments.seed)
    mutations = [draw(paths, generator, tuning) for _ in range(arguments.count)]
    folders = sorted({each for mutation in mutations for each in tests_of(room_of(mutation.path))})
    with ThreadPoolExecutor(arguments.jobs) as pool:
        limits = {name: SLOWER * each + START for name, each in zip(folders, pool.map(duration, folders))}
        results = pool.map(lambda each: is_noticed(each, limits), mutations)
        noticed = 0
        for mutation, good in zip(mutations, results):
            noticed += good
            print(f"{'noticed' if good else 'MISSED '} {mutation.path}:{mutation.line}: {mutation.what}",
                  flush=True)
    print(f'{noticed} of {len(mutations)} mutations noticed')
    return 0


if __name__ == '__main__':
    sys.exit(main())
