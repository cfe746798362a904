#!/usr/bin/python3
"""Writes test/promises.md: which tests hold each promise of docs/reliability.md, from test/promises.yaml."""
import os
import re
import sys

import yaml

ROOT = os.path.realpath(os.path.join(os.path.dirname(__file__), '..'))
TEST = os.path.join(ROOT, 'test')
PAGE = os.path.join(TEST, 'promises.md')
RELIABILITY = os.path.join(ROOT, 'docs', 'reliability.md')
HEAD = """\
# Promises and their tests

`script/promises.py` writes this page; do not edit it. Paths are relative to `test/`.

The promises of [Reliability](../docs/reliability.md), from `promises.yaml`. Each row of the fault suite also holds the
guarantee in [the results](faults/results.md).

| promise | tests |
|---|---|
"""


def read(path):
    """Return the text of a file."""
    with open(path, encoding='utf-8') as file:
        return file.read()


def promises():
    """Return the paths of the tests of each promise."""
    return yaml.safe_load(read(os.path.join(TEST, 'promises.yaml')))


def paragraphs():
    """Return the paragraphs of docs/reliability.md that make promises, each as one line."""
    text = read(RELIABILITY)
    start, end = (text.index(f'\n## {title}\n') for title in ('What is promised', 'What ROS itself does not promise'))
    found = [' '.join(each.split()) for each in text[start:end].split('\n\n')]
    return [each for each in found if each.startswith('**')]


def tests():
    """Return the paths of all rostests, unit tests and rows of the fault suite below test/."""
    paths = [os.path.relpath(os.path.join(folder, name), TEST) for folder, _, names in os.walk(TEST) for name in names]
    return {path for path in paths if re.search(r'(?:^unit/.*test_\w+|rows/\w+)\.py$|\.test$', path)}


def troubles():
    """Return a line for each promise without a test, and for each test that does not exist."""
    page, existing, held = ' '.join(read(RELIABILITY).split()), tests(), promises()
    found = [f'{phrase!r}: expected a phrase of docs/reliability.md' for phrase in held if phrase not in page]
    found += [f'{phrase!r}: {path}: no such test' for phrase, paths in held.items() for path in paths
              if path not in existing]
    found += [f'{phrase!r}: expected a test' for phrase, paths in held.items() if not paths]
    found += [f'{each[:60]}...: expected one of its phrases in test/promises.yaml' for each in paragraphs()
              if not any(phrase in each for phrase in held)]
    return found


def link(path):
    """Return a link to a test."""
    return f'[{path}]({path})'


def page():
    """Return the text of test/promises.md."""
    rows = [f"| {phrase} | {', '.join(map(link, paths))} |" for phrase, paths in promises().items()]
    return HEAD + '\n'.join(rows) + '\n'


def main():
    """Write the page; return the exit status."""
    with open(PAGE, 'w', encoding='utf-8') as file:
        file.write(page())
    print('\n'.join(troubles()), end='')
    return 1 if troubles() else 0


if __name__ == '__main__':
    sys.exit(main())
