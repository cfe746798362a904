#!/usr/bin/env python3
"""Writes the parameters that the nodes declare, and the names of the surfaces, into the files that list them.

A table in docs/ follows a comment: `<!-- parameters: FILE -->` for a node, `<!-- keys: NAME -->` for a part of the
description of a robot, `<!-- keys: SURFACE -->` for surface files. Launch files and script/demo list the surfaces after
`floor:`.
"""
import glob
import importlib.util
import os
import re
import sys

ROOT = os.path.realpath(os.path.join(os.path.dirname(__file__), '..'))
SURFACE_FILES = os.path.join(ROOT, 'config', 'surfaces')
FILES = ['docs/*.md', 'launch/*.launch', 'rbx1_bringup/launch/*.launch*', 'script/demo']
TABLE = re.compile(r'(?m)^<!-- (parameter|key)s: (\S+) -->\n\n(?:\|.*\n)*')
SURFACES = re.compile(r'(?<=floor: )\w+(, \w+)*(?=;)')
sys.path.insert(0, os.path.join(ROOT, 'src'))
os.environ['ROS_PACKAGE_PATH'] = ROOT      # needed to find the surface files


def declared(kind, name):
    """Return the parameters of a node, or the keys of a part of a YAML file."""
    if kind == 'key':
        from rbx1_nav.robot import description
        return getattr(description, name)
    spec = importlib.util.spec_from_file_location('node', os.path.join(ROOT, 'nodes', name))
    node = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(node)
    from rbx1_nav.ros.driving import script
    common = [script.WAIT_TIMEOUT] if getattr(node, 'init_node', None) is script.init_node else []
    return [*node.PARAMETERS, *common]


def surface_table():
    """Return the lines of the table of surface files, with a column for each."""
    from rbx1_nav.config import load_yaml
    from rbx1_nav.simulation import surfaces
    names = [name for name in surfaces.known_surfaces(SURFACE_FILES) if name != 'ideal']
    values = [load_yaml(os.path.join(SURFACE_FILES, f'{name}.yaml')) for name in names]
    rows = [['key', 'unit', 'range', *names, ''], ['---'] * (len(names) + 4)]
    for name, key in surfaces.KEYS.items():
        columns = [f'{each[name]:.7g}' if name in each else '' for each in values]
        rows.append([f'`{name}`', key.unit, f'{key.low:.7g} to {key.high:.7g}', *columns, key.text])
    return [f"| {' | '.join(row)} |" for row in rows]


def filled_in(text):
    """Return the text of a file with up-to-date tables and surfaces."""
    from rbx1_nav.parameters import table
    from rbx1_nav.simulation.surfaces import known_surfaces

    def fill(match):
        kind, name = match.groups()
        lines = surface_table() if name == 'SURFACE' else table(declared(kind, name), kind)
        return f'<!-- {kind}s: {name} -->\n\n' + '\n'.join(lines) + '\n'
    surfaces = ', '.join(known_surfaces(SURFACE_FILES))
    return SURFACES.sub(surfaces, TABLE.sub(fill, text))


def files():
    """Return the paths of the files."""
    return [path for each in FILES for path in glob.glob(os.path.join(ROOT, each))]


def main():
    """Update all files."""
    for path in files():
        with open(path, encoding='utf-8') as file:
            text = file.read()
        if filled_in(text) != text:
            with open(path, 'w', encoding='utf-8') as file:
                file.write(filled_in(text))


if __name__ == '__main__':
    main()
