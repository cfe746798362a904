"""Animated pictures of simulated runs."""
import os

from PIL import Image, ImageChops
from matplotlib.figure import Figure
import pytest

from rbx1_nav.base.robot_parameters import load_robot
from rbx1_nav.exercise.methods import METHODS
from rbx1_nav.extras.many_runs import animation
from rbx1_nav.extras.many_runs.simulated_run import simulate
from rbx1_nav.node.config import ConfigError

ROOT = os.path.join(os.path.dirname(__file__), '..', '..', '..', '..')


@pytest.fixture(scope='module')
def results():
    robot = load_robot(os.path.join(ROOT, 'config', 'turtlebot.yaml'))
    return {method: simulate(method, robot, None, 0, keep=True) for method in METHODS}


@pytest.mark.parametrize('name', ('run.gif', pytest.param('run.png', marks=pytest.mark.skipif(
    'PNG' not in Image.SAVE_ALL, reason='this Pillow writes no animated PNG'))))
def test_frames_and_durations(results, tmp_path, monkeypatch, name):
    monkeypatch.setattr(animation, 'SPEED', 40.0)       # a tenth of the frames
    file = str(tmp_path / name)
    animation.animate(file, 'ideal', {'timed': results['timed']})
    with Image.open(file) as picture:
        assert picture.n_frames == int(results['timed'].end.time / 4) + 2
        first = picture.convert('RGB')
        picture.seek(picture.n_frames - 1)
        assert picture.info['duration'] == 3000
        assert ImageChops.difference(first, picture.convert('RGB')).getbbox()
        assert picture.info['loop'] == 0


def test_the_robot_is_drawn_where_it_is(results):
    axes = Figure().subplots()
    extent = animation.widened((-0.1, 0.5, -1.0, 1.0), results.values())
    assert extent == (pytest.approx(-0.15, abs=0.02), pytest.approx(1.15, abs=0.02), -1.0, 1.0)
    panel = animation.Panel(axes, 'ekf', results['ekf'].path, extent)
    for time in 0.0, 7.0, 1000.0:
        panel.show(time)
        x, y = panel.robot.get_data()
        snapshot = min(results['ekf'].path, key=lambda each: abs(each.time - time))
        assert (x[0], y[0]) == snapshot.truth[:2]
        assert ((x[-2] - x[0]) ** 2 + (y[-2] - y[0]) ** 2) ** 0.5 == pytest.approx(animation.RADIUS)
    assert axes.get_title().endswith('cm from the start')


def test_other_endings_are_rejected(tmp_path):
    with pytest.raises(ConfigError, match='expected a file name with the extension .gif( or .png)?$'):
        animation.check_animation(str(tmp_path / 'run.mp4'))
