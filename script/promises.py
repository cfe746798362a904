#!/usr/bin/python3
"""Writes test/promises.md: which tests hold each promise of docs/reliability.md and each parameter of the reference.

The tests of a promise are listed in test/promises.yaml. The tests of a parameter are those that set or compare it.
"""
import os
import re
import sys

import yaml

import parameter_tables

ROOT = parameter_tables.ROOT
TEST = os.path.join(ROOT, 'test')
PAGE = os.path.join(TEST, 'promises.md')
RELIABILITY = os.path.join(ROOT, 'docs', 'reliability.md')
SHOWN = 3       # tests of a parameter in the table
# what the tests of a node contain: how it is started, or what reads its parameters
NODES = {
    'calibrate_angular.py': r'calibrate_|angular_calibration', 'calibrate_linear.py': r'calibrate_|linear_calibration',
    'ekf.py': r'ekf|estimation|ros/filter|ros\.filter', 'fleet.py': r'fleet',
    'fake_base.py': r'fake_(?:base|turtlebot|pi_robot)|read_robot|ROBOT',
    'fake_create.py': r'fake_create|emulated|Emulat', 'turtlebot_node.py': r'turtlebot_|[dD]riven|create\.driver',
    'timed_out_and_back.py': r'timed_out_and_back|out_and_back\(|/out_and_back',
    'odom_out_and_back.py': r'odom_out_and_back|by_odometry|/out_and_back',
    'true_robot.py': r'true_robot|fake_turtlebot', 'web_view.py': r'web_view|ros\.web|start_view'}
FOR_HARDWARE = 'has no effect; base/start_messages.test counts the parameters that only hardware needs'
SHARED = 'the same declaration and code as in fake_base.py'
ONE_NUMBER = 'a number that the node passes on'
# parameters without a test, and why
UNTESTED = {
    **{('fake_base.py', name): FOR_HARDWARE for name in ('read_rate', 'sync_read', 'sync_write', 'write_rate')},
    **{('fleet.py', name): SHARED for name in ('clock_step', 'rate')},
    **{('turtlebot_node.py', name): SHARED for name in ('diagnostic_period', 'publish_tf')},
    ('web_view.py', 'spacing'): ONE_NUMBER,
    ('calibrate_angular.py', 'min_angular_speed'): 'the same leg as in odom_out_and_back.py',
    ('fleet.py', 'spacing'): ONE_NUMBER,
    ('fleet.py', 'method'): 'documents.test follows docs/several_robots.md, which sets it'}
HEAD = """\
# Promises and their tests

`script/promises.py` writes this page; do not edit it. Paths are relative to `test/`.

## Reliability

The promises of [Reliability](../docs/reliability.md), from `promises.yaml`. Each row of the fault suite also holds the
guarantee in its own table there.

| promise | tests |
|---|---|
"""
PARAMETERS = f"""
## Parameters

Tests in which a parameter has a value, at most {SHOWN} of them.

| node | parameter | tests |
|---|---|---|
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
    """Return the text of each rostest, unit test and row of the fault suite, by its path below test/."""
    found = {}
    for folder, _, names in os.walk(TEST):
        for path in (os.path.join(folder, name) for name in sorted(names)):
            if not os.path.islink(path) and re.search(r'(?:unit/.*test_\w+|rows/\w+)\.py$|\.test$', path):
                text = read(path)
                script = re.search(r'<test [^>]*pkg="rbx1_nav" type="(\w+\.py)"', text)
                found[os.path.relpath(path, TEST)] = text + (read(os.path.join(folder, script[1])) if script else '')
    return found


def parameters():
    """Return the (node, name) of each parameter in the reference, sorted."""
    found = set()
    for path in parameter_tables.files():
        for kind, node in re.findall(r'<!-- (parameter)s: (\S+) -->', read(path)):
            found |= {(node, each.name) for each in parameter_tables.declared(kind, node)}
    return sorted(found)


def tests_of(node, name, texts):
    """Return the paths of the tests that set or compare a parameter; rostests first."""
    value = re.compile(rf'''\b_?{name}(?::?=|['"]?:| ==| = )|['"/]{name}['"]''')
    return sorted((path for path, text in texts.items()
                   if name in text and value.search(text) and re.search(NODES[node], text)),
                  key=lambda path: (not path.endswith('.test'), 'faults' in path, path))


def troubles():
    """Return a line for each promise or parameter without a test, and for each test that does not exist."""
    page, texts, held = ' '.join(read(RELIABILITY).split()), tests(), promises()
    found = [f'{phrase!r}: expected a phrase of docs/reliability.md' for phrase in held if phrase not in page]
    found += [f'{phrase!r}: {path}: no such test' for phrase, paths in held.items() for path in paths
              if path not in texts]
    found += [f'{phrase!r}: expected a test' for phrase, paths in held.items() if not paths]
    found += [f'{each[:60]}...: expected one of its phrases in test/promises.yaml' for each in paragraphs()
              if not any(phrase in each for phrase in held)]
    declared = parameters()
    found += [f'{node} ~{name}: expected a test that sets it' for node, name in declared
              if (node, name) not in UNTESTED and not tests_of(node, name, texts)]
    found += [f'{node} ~{name}: expected no exception, because a test sets it' for node, name in UNTESTED
              if (node, name) not in declared or tests_of(node, name, texts)]
    return found


def link(path):
    """Return a link to a test."""
    return f'[{path}]({path})'


def page():
    """Return the text of test/promises.md."""
    texts = tests()
    rows = [f"| {phrase} | {', '.join(map(link, paths))} |" for phrase, paths in promises().items()]
    table = []
    for node, name in parameters():
        paths = tests_of(node, name, texts)
        shown = ', '.join(map(link, paths[:SHOWN])) or f'none: {UNTESTED.get((node, name))}'
        more = f' and {len(paths) - SHOWN} more' if len(paths) > SHOWN else ''
        table.append(f'| `{node}` | `~{name}` | {shown}{more} |')
    return HEAD + '\n'.join(rows) + '\n' + PARAMETERS + '\n'.join(table) + '\n'


def main():
    """Write the page; return the exit status."""
    with open(PAGE, 'w', encoding='utf-8') as file:
        file.write(page())
    print('\n'.join(troubles()), end='')
    return 1 if troubles() else 0


if __name__ == '__main__':
    sys.exit(main())
