"""Truth, odometry and estimate have the same colors in RViz and the browser as in plots, and differ in luminance."""
from itertools import combinations, product
import os
import re

import pytest
import yaml
from rbx1_nav.extras.many_runs.plots import ESTIMATE, ODOMETRY, ON_DARK, TRUTH

ROOT = os.path.join(os.path.dirname(__file__), '..', '..', '..', '..')
ON_LIGHT = TRUTH, ODOMETRY, ESTIMATE


@pytest.mark.parametrize('name, count', [('sim', 2), ('nav_ekf', 3)])
def test_rviz(name, count):
    with open(os.path.join(ROOT, 'rviz', f'{name}.rviz'), encoding='utf-8') as file:
        displays = yaml.safe_load(file)['Visualization Manager']['Displays']
    shown = {each['Topic']: '#%02x%02x%02x' % tuple(map(int, each['Shape']['Color'].split(';')))
             for each in displays if each['Class'] == 'rviz/Odometry'}
    assert len(shown) == count and shown.items() <= dict(zip(('/ground_truth', '/odom', '/odom_ekf'), ON_DARK)).items()


def test_the_browser_with_a_light_and_a_dark_background():
    with open(os.path.join(ROOT, 'web', 'style.css'), encoding='utf-8') as file:
        style = file.read()
    for name, *colors in zip(('truth', 'odometry', 'estimate'), ON_LIGHT, ON_DARK):
        assert re.findall(rf'--{name}: (#\w+);', style) == colors


def luminance(color):
    """Return the relative luminance of a color as #rrggbb, as WCAG 2 defines it."""
    parts = [int(color[index:index + 2], 16) / 255 for index in (1, 3, 5)]
    red, green, blue = [part / 12.92 if part <= 0.04045 else ((part + 0.055) / 1.055) ** 2.4 for part in parts]
    return 0.2126 * red + 0.7152 * green + 0.0722 * blue


def contrast(one, other):
    dark, light = sorted(map(luminance, (one, other)))
    return (light + 0.05) / (dark + 0.05)


@pytest.mark.parametrize('colors, backgrounds', [
    (ON_LIGHT, ['#ffffff', '#f7f8fa']), (ON_DARK, ['#303030', '#26292e'])])     # plots and page; RViz and page
def test_luminance(colors, backgrounds):
    assert min(contrast(*pair) for pair in combinations(colors, 2)) > 1.5
    # 3: WCAG 2, for graphics
    assert min(contrast(*pair) for pair in product(colors, backgrounds)) > 3
