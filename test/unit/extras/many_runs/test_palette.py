"""Truth, odometry and estimate have the same colors in RViz and in the browser as in plots."""
import os
import re

import pytest
import yaml
from rbx1_nav.extras.many_runs.plots import ESTIMATE, ODOMETRY, TRUTH

ROOT = os.path.join(os.path.dirname(__file__), '..', '..', '..', '..')
BY_TOPIC = {'/ground_truth': TRUTH, '/odom': ODOMETRY, '/odom_ekf': ESTIMATE}


@pytest.mark.parametrize('name, count', [('sim', 2), ('nav_ekf', 3)])
def test_rviz(name, count):
    with open(os.path.join(ROOT, 'rviz', f'{name}.rviz'), encoding='utf-8') as file:
        displays = yaml.safe_load(file)['Visualization Manager']['Displays']
    shown = {each['Topic']: '#%02x%02x%02x' % tuple(map(int, each['Shape']['Color'].split(';')))
             for each in displays if each['Class'] == 'rviz/Odometry'}
    assert len(shown) == count and shown.items() <= BY_TOPIC.items()


def test_the_browser_with_a_light_and_a_dark_background():
    with open(os.path.join(ROOT, 'web', 'style.css'), encoding='utf-8') as file:
        style = file.read()
    for name, color in ('truth', TRUTH), ('odometry', ODOMETRY), ('estimate', ESTIMATE):
        assert re.findall(rf'--{name}: (#\w+);', style) == [color] * 2
