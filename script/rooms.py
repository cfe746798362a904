#!/usr/bin/env python3
"""Draws in CONTRIBUTING.md which rooms import which. A room is a folder of src/rbx1_nav, or nodes/.

An arrow to a room to which other arrows lead is left out.
"""
import ast
import importlib.util
import os
import re

ROOT = os.path.realpath(os.path.join(os.path.dirname(__file__), '..'))
SOURCE = os.path.join(ROOT, 'src')
PAGE = os.path.join(ROOT, 'CONTRIBUTING.md')
DIAGRAM = re.compile(r'(?m)(?<=^<!-- imports -->\n)\n```mermaid\n(?:.*\n)*?```$')


def python_files(folder):
    """Return the paths of all Python files below a folder."""
    return sorted(os.path.join(parent, file) for parent, _, files in os.walk(folder)
                  for file in files if file.endswith('.py'))


def modules():
    """Yield (path, full name, whether it is a package) of all modules and nodes; the name of a node is nodes.NAME."""
    for path in python_files(SOURCE):
        parts = os.path.relpath(path, SOURCE)[:-len('.py')].split(os.sep)
        is_package = parts[-1] == '__init__'
        yield path, '.'.join(parts[:-1] if is_package else parts), is_package
    for path in python_files(os.path.join(ROOT, 'nodes')):
        yield path, f"nodes.{os.path.basename(path)[:-len('.py')]}", False


def is_module(name):
    """Return whether a full name refers to a module or a package in SOURCE."""
    path = os.path.join(SOURCE, *name.split('.'))
    return os.path.isdir(path) or os.path.isfile(f'{path}.py')


def imported_modules(source, module, is_package):
    """Yield the full names of all modules that a source imports; '?' for a dynamic import without a literal name."""
    package = module if is_package else module.rpartition('.')[0]
    for node in ast.walk(ast.parse(source)):
        if isinstance(node, ast.Import):
            yield from (alias.name for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            parent = node.module or ''
            if node.level:
                parent = importlib.util.resolve_name('.' * node.level + parent, package)
            # the imported name may itself be a module: `from rbx1_nav.base import units`
            yield from {name if is_module(name) else parent for name in (
                f'{parent}.{alias.name}' for alias in node.names)}
        elif isinstance(node, ast.Call):
            function = getattr(node.func, 'attr', getattr(node.func, 'id', None))
            if function in ('__import__', 'import_module'):
                name = node.args[0].value if node.args and isinstance(node.args[0], ast.Constant) else '?'
                yield importlib.util.resolve_name(name, package)


def folder_of(module):
    """Return the folder of a module as it is drawn, such as 'extras/create/'; '' if it is in no room."""
    if module.startswith('nodes.'):
        return 'nodes/'
    package = module if os.path.isdir(os.path.join(SOURCE, *module.split('.'))) else module.rpartition('.')[0]
    return ''.join(f'{part}/' for part in package.split('.')[1:])


def file_arrows():
    """Return a set of pairs: a module, and another module of the package that it imports."""
    found = set()
    for path, module, is_package in modules():
        with open(path, encoding='utf-8') as file:
            imported = imported_modules(file.read(), module, is_package)
            found.update((module, name) for name in imported if name.startswith('rbx1_nav'))
    return found


def arrows():
    """Return a set of pairs: the folder of a module, and another folder that it imports from."""
    found = {(folder_of(module), folder_of(name)) for module, name in file_arrows()}
    return {(room, other) for room, other in found if room and other and room != other}


def circles(pairs):
    """Return a sorted list of all that a chain of arrows leads back to."""
    return sorted({start for start, _ in pairs if start in reachable(pairs, start)})


def reachable(pairs, room):
    """Return the set of all rooms to which arrows lead from a room."""
    found, new = set(), {room}
    while new:
        new = {end for start, end in pairs if start in new} - found
        found |= new
    return found


def diagram():
    """Return the diagram as Mermaid text, without the arrows that are left out."""
    pairs = arrows()
    needed = sorted((room, other) for room, other in pairs if other not in reachable(pairs - {(room, other)}, room))
    names = {room: room.strip('/').replace('/', '_') for room in sorted({room for pair in pairs for room in pair})}
    shapes = [f'{name}["{room}"]' for room, name in names.items()]
    return '\n    '.join(['flowchart TD', *shapes, *(f'{names[room]} --> {names[other]}' for room, other in needed)])


def filled_in(text):
    """Return the text of the page with an up-to-date diagram."""
    return DIAGRAM.sub(lambda _: f'\n```mermaid\n{diagram()}\n```', text)


def main():
    """Update the page."""
    with open(PAGE, encoding='utf-8') as file:
        text = file.read()
    with open(PAGE, 'w', encoding='utf-8') as file:
        file.write(filled_in(text))


if __name__ == '__main__':
    main()
