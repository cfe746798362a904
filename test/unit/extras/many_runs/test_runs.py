"""The plot of simulated runs: one scale for all methods, and no color scale without visible differences."""
from contextlib import contextmanager
from math import pi, radians
import resource
import signal
import sys

import numpy
import pytest
from matplotlib.figure import Figure

from rbx1_nav.base.kinematics import Pose
from rbx1_nav.extras.many_runs.plots import check_picture, draw, square, with_heading_errors
from rbx1_nav.extras.many_runs.simulated_run import SimulationResult, Snapshot
from rbx1_nav.node.config import ConfigError


def result(*poses):
    """Return a SimulationResult with this path, whose last pose is the end pose."""
    snapshots = [Snapshot(0.02 * number, Pose(*pose), Pose(*pose), None) for number, pose in enumerate(poses)]
    return SimulationResult(snapshots[-1], 1.0, None, snapshots)


FAR = [result((0, 0, 0), (0.1, y, 2 * pi - radians(60))) for y in (0.4, 0.5, 0.6)]
NEAR = [result((0, 0, 0), (0.0, y, 2 * pi + radians(10))) for y in (-0.01, 0.0, 0.02)]


def ends(results):
    """Return the true end poses of results, an array (n, 3)."""
    return numpy.array([each.end.truth for each in results])


def test_the_absolute_heading_error_in_degrees():
    assert with_heading_errors(ends(FAR))[:, 2] == pytest.approx([60] * 3)
    assert with_heading_errors(ends(NEAR))[:, 2] == pytest.approx([10] * 3)


def test_the_extent_is_square_and_holds_the_start_and_all_ends():
    xmin, xmax, ymin, ymax = square([ends(FAR)[:, :2], ends(NEAR)[:, :2]], 0.05, 0.6)
    assert xmax - xmin == pytest.approx(ymax - ymin)
    assert xmin < 0 < 0.1 < xmax and ymin < -0.01 and 0.6 < ymax


@pytest.fixture
def drawn(monkeypatch, tmp_path):
    """Provide a function that calls draw(results) and returns the saved Figure."""
    figures = []
    monkeypatch.setattr(Figure, 'savefig', lambda figure, *_, **__: figures.append(figure))

    def call(results, seeds=range(3), truths=None):
        draw(str(tmp_path / 'a.png'), 'test', results, seeds,
             truths or {key: ends(each) for key, each in results.items()})
        return figures[-1]
    return call


def test_the_lower_row_has_one_scale_and_one_colour_bar(drawn):
    figure = drawn({'timed': FAR, 'ekf': NEAR})
    *panels, bar = figure.axes
    lower = panels[2:]
    assert len(panels) == 4 and bar.get_ylabel() == 'heading error (degrees)'
    assert lower[0].get_xlim() == lower[1].get_xlim() and lower[0].get_ylim() == lower[1].get_ylim()
    assert lower[0].collections[0].norm is lower[1].collections[0].norm


def test_a_picture_of_many_runs_has_few_points_and_the_mean_of_all(drawn):
    truths = numpy.zeros((20000, 3))
    truths[:, 0] = numpy.linspace(0, 1, 20000)
    figure = drawn({'timed': NEAR}, range(7, 20007), {'timed': truths})
    above, below = figure.axes[:2]
    assert len(below.collections[0].get_offsets()) == 5000 and below.get_xlim()[1] < 0.3
    assert above.get_title().startswith('timed: mean 50.0 cm from the start')
    assert figure._suptitle.get_text().endswith('20000 runs (seeds 7 to 20006); the end poses of the first 5000')
    assert figure.axes[1].collections[0].get_sizes() < drawn({'timed': FAR}).axes[1].collections[0].get_sizes()


@contextmanager
def full_disk():
    """Limit the size of files to 1000 bytes. The limit also applies to pytest's output, so use it for part of a test.

    Unlike a small file system, this does not require root. It also raises OSError.
    """
    before = resource.getrlimit(resource.RLIMIT_FSIZE)
    handler = signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
    resource.setrlimit(resource.RLIMIT_FSIZE, (1000, before[1]))
    dont_write_bytecode, sys.dont_write_bytecode = sys.dont_write_bytecode, True    # it would be cut short
    try:
        yield
    finally:
        sys.dont_write_bytecode = dont_write_bytecode
        resource.setrlimit(resource.RLIMIT_FSIZE, before)
        signal.signal(signal.SIGXFSZ, handler)


def test_an_older_picture_survives_a_full_disk(tmp_path):
    path = tmp_path / 'a.png'
    path.write_bytes(b'an older picture')
    with full_disk(), pytest.raises(OSError):
        draw(str(path), 'test', {'timed': FAR}, range(3), {'timed': ends(FAR)})
    assert list(tmp_path.iterdir()) == [path] and path.read_bytes() == b'an older picture'


@pytest.mark.parametrize('kind, start', [('png', b'\x89PNG'), ('PDF', b'%PDF'), ('svg', b'<?xml')])
def test_a_picture_takes_the_place_of_an_older_one(tmp_path, kind, start):
    path = tmp_path / (f'a.{kind}')
    path.write_bytes(b'an older picture')
    path.chmod(0o640)
    (tmp_path / (f'link.{kind}')).symlink_to(path)
    draw(str(tmp_path / (f'link.{kind}')), 'test', {'timed': FAR}, range(3), {'timed': ends(FAR)})
    assert path.read_bytes().startswith(start) and path.stat().st_mode & 0o777 == 0o640
    assert len(list(tmp_path.iterdir())) == 2


# check_picture() checks before the runs that a plot can be written

@pytest.mark.parametrize('name', ['a.png', 'a.PNG', 'a.svg', 'a.pdf', 'a.b.svg'])
def test_a_good_path_is_left_as_it_was(tmp_path, name):
    check_picture(str(tmp_path / name))
    assert list(tmp_path.iterdir()) == []
    (tmp_path / name).write_bytes(b'an older picture')
    check_picture(str(tmp_path / name))
    assert (tmp_path / name).read_bytes() == b'an older picture'


@pytest.mark.parametrize('name', ['', 'a', 'png', '.png', 'a.doc', 'a.png.txt', 'a.pgf'])
def test_a_name_that_says_no_format(tmp_path, name):
    with pytest.raises(ConfigError, match=r'expected a file name with one of the extensions .*\.pdf, \.png, '):
        check_picture(f'{tmp_path!s}/{name}')
