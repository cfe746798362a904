"""turtlebot_node.py accepts the files in config/create/, which match its defaults."""
import glob
import os

import pytest
import yaml

from rbx1_nav.create.driver.settings import read_settings

FOLDER = os.path.join(os.path.dirname(__file__), '..', '..', '..', 'config', 'create')
CALIBRATIONS = sorted(glob.glob(os.path.join(FOLDER, 'calibration', '*.yaml')))


def load(*path):
    """Return the content of a file."""
    with open(os.path.join(FOLDER, *path), encoding='utf-8') as file:
        return yaml.safe_load(file)


def test_the_files_have_the_defaults_of_the_node():
    assert read_settings({**load('parameters.yaml'), **load('calibration', 'default.yaml')}) == read_settings({})


@pytest.mark.parametrize('path', CALIBRATIONS, ids=os.path.basename)
@pytest.mark.parametrize('robot_type', ['create', 'create2'])
def test_a_calibration_is_accepted_and_complete(path, robot_type):
    calibration = load('calibration', os.path.basename(path))
    params = {**load('parameters.yaml'), **calibration, 'robot_type': robot_type}
    assert not read_settings(params)[1].unknown
    assert calibration.keys() == load('calibration', 'default.yaml').keys()
