"""Each promise of docs/reliability.md has a test: test/promises.yaml lists them."""
import os
import re

import yaml

ROOT = os.path.realpath(os.path.join(os.path.dirname(__file__), '..', '..'))
TEST = os.path.join(ROOT, 'test')


def read(*path):
    with open(os.path.join(ROOT, *path), encoding='utf-8') as file:
        return file.read()


def problems(held):
    """A line for each promise without a test, and for each test that does not exist. held: tests of each promise."""
    text = read('docs', 'reliability.md')
    start, end = (text.index(f'\n## {title}\n') for title in ('What is promised', 'What ROS itself does not promise'))
    paragraphs = [' '.join(each.split()) for each in text[start:end].split('\n\n') if each.startswith('**')]
    paths = [os.path.relpath(os.path.join(folder, name), TEST) for folder, _, names in os.walk(TEST) for name in names]
    tests = {path for path in paths if re.search(r'(?:^unit/.*test_\w+|rows/\w+)\.py$|\.test$', path)}
    return [*(f'{phrase!r}: expected a phrase of docs/reliability.md' for phrase in held
              if phrase not in ' '.join(text.split())),
            *(f'{phrase!r}: {path}: no such test' for phrase in held for path in set(held[phrase]) - tests),
            *(f'{phrase!r}: expected a test' for phrase in held if not held[phrase]),
            *(f'{each[:60]}...: expected one of its phrases in test/promises.yaml' for each in paragraphs
              if not any(phrase in each for phrase in held))]


def test_each_promise_has_a_test():
    assert problems(yaml.safe_load(read('test', 'promises.yaml'))) == []


def test_what_is_missing_is_named():
    held = yaml.safe_load(read('test', 'promises.yaml'))
    held['The robot flies'] = ['driving/flight.test']
    held['An outage has no effect'] = []
    del held['A gyro without power']
    found = problems(held)
    for text in ("'The robot flies': expected a phrase", "'The robot flies': driving/flight.test: no such test",
                 "'An outage has no effect': expected a test", '**A gyro without power** is reported'):
        assert [line for line in found if text in line], (text, found)
