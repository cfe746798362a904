"""The file with end poses that were measured by hand."""
from math import radians

import pytest

from rbx1_nav.extras.fitting.end_poses import read_ends
from rbx1_nav.node.config import ConfigError


def read(tmp_path, text, bags=('/runs/run1.bag', 'run2.bag')):
    """Return the result of read_ends() for a text."""
    path = tmp_path / 'ends.yaml'
    path.write_text(text)
    return read_ends(str(path), list(bags))


def test_ends_by_the_names_of_bags(tmp_path):
    ends, errors = read(tmp_path, 'run2.bag: [1, 2.5, -90]\nrun1.bag: [0.02, 0.35, -12]\n')
    assert ends[0] == pytest.approx((0.02, 0.35, radians(-12))) and ends[1] == pytest.approx((1, 2.5, radians(-90)))
    assert errors == pytest.approx((0.01, 0.01, radians(2)))


def test_errors_of_the_tape(tmp_path):
    _, errors = read(tmp_path, 'run1.bag: [0, 0, 0]\nposition_error: 0.002\nheading_error: 0.5', ['run1.bag'])
    assert errors == pytest.approx((0.002, 0.002, radians(0.5)))


@pytest.mark.parametrize('text, expected', [
    ('', 'None: expected a mapping'),
    ('run1.bag: [0, 0, 0]', 'run2.bag: missing: expected [x in m, y in m, heading in degrees]'),
    ('run1.bag: [0, 0]\nrun2.bag: [0, 0, 0]', 'run1.bag: [0, 0]: expected [x in m'),
    ('run1.bag: 5\nrun2.bag: [0, 0, 0]', 'run1.bag: 5: expected [x in m'),
    ('run1.bag: [0, .nan, 0]\nrun2.bag: [0, 0, 0]', 'run1.bag/y: nan: expected a number from -1000 to 1000 in m'),
    ('run1.bag: [0, 0, a]\nrun2.bag: [0, 0, 0]', "run1.bag/heading: 'a': expected a number from"),
    ('run1.bag: [0, 0, 0]\nrun2.bag: [0, 0, 0]\nrun3.bag: [0, 0, 0]', 'run3.bag (did you mean run'),
    ('run1.bag: [0, 0, 0]\nrun2.bag: [0, 0, 0]\nposition_error: 0', 'position_error: 0: expected a number from 0.0001'),
    ('run1.bag: [', 'expected a YAML file')])
def test_one_line_for_a_mistake(tmp_path, text, expected):
    with pytest.raises(ConfigError) as error:
        read(tmp_path, text)
    assert expected in str(error.value) and 'ends.yaml: ' in str(error.value) and '\n' not in str(error.value)


def test_two_bags_of_one_name(tmp_path):
    with pytest.raises(ConfigError, match='run1.bag: two bags have this name'):
        read(tmp_path, 'run1.bag: [0, 0, 0]', ['a/run1.bag', 'b/run1.bag'])
