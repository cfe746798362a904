#!/usr/bin/env python3
"""Prints a robot's URDF file for a launch file, and expands it first if it is a xacro file.

Exits with 1, and one line, if the file is not a URDF file.
"""
from __future__ import annotations

import argparse
import re
import shutil
import subprocess
import sys
from typing import Sequence

from rbx1_nav.base.urdf import is_xacro, read_tree

LINK = re.compile(r'(<(?:link|parent|child)\s+(?:name|link)=.)')
ALPHA = re.compile(r'(rgba=.[^ ]+ +[^ ]+ +[^ ]+) +[0-9.]+')


def read(path: str, values: Sequence[str]) -> str:
    """Return the text of a URDF file, or of a xacro file with values of its arguments, NAME:=VALUE. Raises OSError,
    ValueError or subprocess.CalledProcessError."""
    with open(path, encoding='utf-8', errors='replace') as file:
        text = file.read()
    if (is_xacro(text) or path.endswith('.xacro')) and shutil.which('xacro'):
        text = subprocess.run(['xacro', path, *values], stdout=subprocess.PIPE, check=True, encoding='utf-8').stdout
    read_tree(text)
    return text


def main() -> int:
    """Print the text; return the exit status."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument('--prefix', default='', help='text that is put before the name of each link')
    parser.add_argument('--alpha', help='opacity of all colors, 0 to 1')
    parser.add_argument('file', metavar='FILE')
    parser.add_argument('values', nargs='*', metavar='NAME:=VALUE', help='argument of a xacro file')
    arguments = parser.parse_args()
    try:
        text = read(arguments.file, arguments.values)
    except subprocess.CalledProcessError as error:     # xacro has printed the reason
        print(f'model: {arguments.file}: xacro exited with status {error.returncode}', file=sys.stderr)
        return 1
    except (OSError, ValueError) as error:
        print(f'model: {arguments.file}: {error}', file=sys.stderr)
        return 1
    text = LINK.sub(r'\g<1>' + arguments.prefix, text)
    print(ALPHA.sub(r'\1 ' + arguments.alpha, text) if arguments.alpha else text, end='')
    return 0


if __name__ == '__main__':
    sys.exit(main())
