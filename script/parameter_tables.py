#!/usr/bin/env python3
"""Writes the tables of the parameters that the nodes declare into the pages in docs/.

A table follows a comment: `<!-- parameters: FILE -->` for a node, `<!-- keys: NAME -->` for a part of a YAML file.
"""
import glob
import importlib.util
import os
import re
import sys

ROOT = os.path.realpath(os.path.join(os.path.dirname(__file__), '..'))
TABLE = re.compile(r'(?m)^<!-- (parameter|key)s: (\S+) -->\n\n(?:\|.*\n)*')
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


def filled_in(text):
    """Return the page with up-to-date tables."""
    from rbx1_nav.parameters import table

    def fill(match):
        kind, name = match.groups()
        return f'<!-- {kind}s: {name} -->\n\n' + '\n'.join(table(declared(kind, name), kind)) + '\n'
    return TABLE.sub(fill, text)


def main():
    """Update all pages."""
    for page in glob.glob(os.path.join(ROOT, 'docs', '*.md')):
        with open(page, encoding='utf-8') as file:
            text = file.read()
        if filled_in(text) != text:
            with open(page, 'w', encoding='utf-8') as file:
                file.write(filled_in(text))


if __name__ == '__main__':
    main()
