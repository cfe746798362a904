#!/usr/bin/env python3
"""Writes the parameters that the nodes declare, the surfaces and the methods into the files that list them.

A table in docs/ follows a comment: `<!-- parameters: FILE -->` for a node, or `<!-- parameters: FILE beyond OTHER -->`
without the parameters of another node, `<!-- keys: NAME -->` for a part of the description of a robot, `<!-- keys:
SURFACE -->` for surface files. Launch files and script/demo list the surfaces after `floor:`, fleet.launch and
fleet_robot.launch the methods without the filter; the page has a button for each method.
"""
import glob
import importlib.util
import os
import re
import sys

ROOT = os.path.realpath(os.path.join(os.path.dirname(__file__), '..'))
SURFACE_FILES = os.path.join(ROOT, 'config', 'surfaces')
FILES = ['docs/*.md', 'launch/*.launch', 'rbx1_bringup/launch/*.launch*', 'script/demo', 'web/index.html']
TABLE = re.compile(r'(?m)^<!-- (parameter|key)s: (\S+)( beyond (\S+))? -->\n\n(?:\|.*\n)*')
SURFACES = re.compile(r'((?:doc="|NAME   )floor: )[^;\n]+')
BUTTON = ('        <button type="button" class="run" data-method="{0.name}" data-pose="{0.pose}" data-name="{0.title}" '
          'disabled></button>\n')
BUTTONS = re.compile(r'(?m)(?:^ *<button type="button" class="run".*\n)+')
FLEET = re.compile(r"""(doc="script that drives each robot: none, |arg\('method'\) in ')[\w, ]+""")
sys.path.insert(0, os.path.join(ROOT, 'src'))
os.environ['ROS_PACKAGE_PATH'] = ROOT      # needed to find the surface files


def declared(kind, name):
    """Return the parameters of a node, or the keys of a part of a YAML file."""
    if kind == 'key':
        from rbx1_nav.base import robot_parameters
        return getattr(robot_parameters, name)
    spec = importlib.util.spec_from_file_location('node', os.path.join(ROOT, 'nodes', name))
    node = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(node)
    if not hasattr(node, 'Drive'):
        return node.PARAMETERS
    from rbx1_nav.driving.script import WAIT_TIMEOUT
    from rbx1_nav.node.parameters import split_usage
    return [*getattr(node, 'PARAMETERS', split_usage(node.__doc__)[1]), WAIT_TIMEOUT]


def surface_table():
    """Return the lines of the table of the keys of surface files."""
    from rbx1_nav.base.surfaces import KEYS, Surface
    rows = [['key', ''], ['---', '---']]
    for name, key in KEYS.items():
        limits = f'{key.low:.7g} to {key.high:.7g} {key.unit}'.strip()
        rows.append([f'`{name}`', f"{key.text} ({limits}{'; optional' if name in Surface._field_defaults else ''})"])
    return [f"| {' | '.join(row)} |" for row in rows]


def filled_in(text):
    """Return the text of a file with up-to-date tables, surfaces and methods."""
    from rbx1_nav.exercise.methods import METHODS
    from rbx1_nav.node.parameters import table
    from rbx1_nav.base.surfaces import known_surfaces

    def fill(match):
        kind, name, beyond, other = match.groups()
        known = [table([each]) for each in (declared(kind, other) if other else ())]
        lines = surface_table() if name == 'SURFACE' else table(
            [each for each in declared(kind, name) if table([each]) not in known], kind)
        return f'<!-- {kind}s: {name}{beyond or ""} -->\n\n' + '\n'.join(lines) + '\n'
    surfaces = ', '.join(known_surfaces(SURFACE_FILES))
    buttons = ''.join(map(BUTTON.format, METHODS.values()))
    fleet = ', '.join(each.name for each in METHODS.values() if not each.filtered)
    for pattern, listed in (SURFACES, surfaces), (FLEET, fleet):
        text = pattern.sub(lambda match: match[1] + listed, text)
    return BUTTONS.sub(buttons, TABLE.sub(fill, text))


def files():
    """Return the paths of the files."""
    return [path for each in FILES for path in glob.glob(os.path.join(ROOT, each))]


def main():
    """Update all files."""
    from rbx1_nav.node.config import ConfigError
    changed = {}
    for path in files():
        with open(path, encoding='utf-8') as file:
            text = file.read()
        try:
            filled = filled_in(text)
        except ConfigError as error:
            sys.exit(str(error))
        if filled != text:
            changed[path] = filled
    for path, text in changed.items():
        with open(path, 'w', encoding='utf-8') as file:
            file.write(text)


if __name__ == '__main__':
    main()
