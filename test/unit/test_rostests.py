"""No two rostests share a name or a script.

roslaunch runs the first script with a matching name in the package, and rostest overwrites the result of another test
with the same name.
"""
import collections
import os
import sys
import xml.etree.ElementTree as ElementTree

import pytest

ROOT = os.path.normpath(os.path.join(os.path.dirname(__file__), '..', '..'))
sys.path.insert(0, os.path.join(ROOT, 'script'))
import run_tests        # noqa: E402    found by the line above

FILES = sorted(os.path.join(folder, file) for folder, _, files in os.walk(os.path.join(ROOT, 'test'))
               for file in files if file.endswith('.test'))
NAMES = collections.Counter(map(os.path.basename, FILES))


def elements(path):
    """The <test> elements of a .test file."""
    return list(ElementTree.parse(path).iter('test'))


@pytest.mark.parametrize('path', FILES, ids=os.path.basename)
def test_a_test_has_the_name_of_its_file(path):
    folder, name = os.path.split(os.path.splitext(path)[0])
    unique = NAMES[os.path.basename(path)] == 1
    assert [test.get('test-name') for test in elements(path)] == [
        name if unique else f'{os.path.basename(folder)}_{name}']


@pytest.mark.parametrize('path', FILES, ids=os.path.basename)
def test_there_is_one_script_of_its_name(path):
    for test in elements(path):
        if test.get('pkg') == 'rbx1_nav':
            scripts = [os.path.join(folder, test.get('type')) for folder, _, files in os.walk(ROOT)
                       if test.get('type') in files]
            assert scripts == [os.path.join(os.path.dirname(path), test.get('type'))]
            assert os.access(scripts[0], os.X_OK)


@pytest.mark.parametrize('members', run_tests.SETS.values(), ids=lambda members: members[0])
def test_the_tests_of_a_set_have_the_same_setup(members):
    paths = {os.path.splitext(os.path.basename(path))[0]: path for path in FILES}
    assert len({run_tests.read_setup(paths[member])[0].strip() for member in members}) == 1
    # together.py passes arguments, but no parameters
    assert not any(list(test) for member in members for test in elements(paths[member]))
