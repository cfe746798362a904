"""fit_surface.py on the command line writes a file and a picture, or prints one line and writes nothing."""
import os
import subprocess
import sys

import numpy
import pytest

from rbx1_nav.base.surfaces import load_surface
from sample_bags import run_messages, write_bag

ROOT = os.path.normpath(os.path.join(os.path.dirname(__file__), '..', '..', '..', '..'))
SURFACES = os.path.join(ROOT, 'config', 'surfaces')
NODE = os.path.join(ROOT, 'nodes', 'fit_surface.py')
PATHS = [os.path.join(ROOT, 'src')] + [path for path in sys.path if path]
ENVIRONMENT = dict(os.environ, PYTHONPATH=os.pathsep.join(PATHS))


def fit(folder, *arguments):
    """Run fit_surface.py in a folder; return its exit status, its output and its last error line."""
    process = subprocess.run([sys.executable, NODE, *arguments], cwd=str(folder), env=ENVIRONMENT, text=True,
                             stdout=subprocess.PIPE, stderr=subprocess.PIPE)
    assert 'Traceback' not in process.stderr
    return process.returncode, process.stdout, (process.stderr.splitlines() or [''])[-1]


@pytest.fixture(name='folder')
def folder_with_bags(tmp_path):
    for number in (1, 2, 3):
        write_bag(tmp_path / ('run%d.bag' % number), run_messages())
    # end pose of the odometry, which follows immediately and without error: after 3.65 rad
    last = [message for topic, message, _ in run_messages() if topic == '/odom'][-1].pose.pose
    with open(str(tmp_path / 'ends.yaml'), 'w', encoding='utf-8') as file:
        for number in (1, 2, 3):
            file.write('run%d.bag: [%.3f, %.3f, %.1f]\n' % (number, last.position.x, last.position.y, 209.1))
    return tmp_path


def test_ends_by_tape(folder):
    status, output, error = fit(folder, 'run1.bag', 'run2.bag', 'run3.bag', '--ends', 'ends.yaml', '--output',
                                'floor.yaml', '--plot', 'fit.svg')
    assert (status, error) == (0, '')
    assert output.splitlines()[-2:] == ['Surface: floor.yaml', 'Picture: fit.svg']
    surface = load_surface(str(folder / 'floor.yaml'), SURFACES)
    # a robot without errors: the slip is smaller than a tape can measure
    assert abs(surface.slip_turning) < 0.02 and surface.drag_straight < 1e-3
    assert (folder / 'fit.svg').read_text(encoding='utf-8').startswith('<?xml')


def test_the_truth_of_a_robot_without_errors(folder):
    status, output, error = fit(folder, 'run1.bag', '--truth', '/ground_truth', '--output', 'floor.yaml')
    assert (status, error) == (0, '')
    surface = load_surface(str(folder / 'floor.yaml'), SURFACES)
    # three windows of 2 s contain little information, but more than the 0.03 of the start surface
    assert abs(surface.slip_turning) < 0.01 and surface.drag_turning < 1e-3
    assert 'Not fitted, taken from low_ply_carpet:' in output and '1 of at least 3 runs' in output


def test_text_files_begin_with_the_floor_of_creates(tmp_path):
    time = numpy.arange(0, 30, 0.1)
    speed = numpy.where((time > 2) & (time < 26), 0.1, 0.0)
    numpy.savetxt(str(tmp_path / 'D1R1_Odometry.dat'), numpy.transpose([time, speed, 0 * time]))
    x = 0.1 * numpy.clip(time - 2.2, 0, 24)
    numpy.savetxt(str(tmp_path / 'D1R1_Groundtruth.dat'), numpy.transpose([time, x, 0 * time, 0 * time]))
    status, output, error = fit(tmp_path, 'D1R1_Odometry.dat', '--output', 'floor.yaml')
    assert (status, error) == (0, '')
    assert 'Not fitted, taken from create_lab_floor:' in output
    assert load_surface(str(tmp_path / 'floor.yaml'), SURFACES).drag_straight < 1e-5
    status, output, _ = fit(tmp_path, 'D1R1_Odometry.dat', '--output', 'floor.yaml', '--start', 'hard_floor')
    assert status == 0 and 'Not fitted, taken from hard_floor:' in output


@pytest.mark.parametrize('arguments, status, text', [
    (['ends.yaml'], 1, 'fit_surface.py: ends.yaml: expected a bag: '),
    (['nothing.bag'], 1, 'fit_surface.py: nothing.bag: expected a bag: [Errno 2] No such file or directory: '),
    (['run1.bag', '--truth', '/mocap'], 1,
     '/mocap: no messages of type nav_msgs/Odometry or geometry_msgs/PoseStamped'),
    (['run1.bag', '--odom', '/mocap'], 1, 'run1.bag: neither odometry nor truth: expected at least one of them'),
    (['run1.bag', '--start', 'sand'], 1, "surface: 'sand': expected one of "),
    (['run1.bag', '--start', 'ideal'], 1, '--start: ideal: the ideal surface: expected one with values'),
    (['run1.bag', '--config', '/nowhere.yaml'], 1, '/nowhere.yaml: expected a YAML file'),
    (['D1R1_Odometry.dat'], 1, 'D1R1_Odometry.dat: expected a text file of numbers: '),
    (['run1.bag', '--truth', 'odom'], 2, '/odom: given twice: expected different topics'),
    (['run1.bag', '--cmd-vel', ''], 2, "--cmd-vel: '': expected a topic"),
    (['run1.bag', '--truth', '/a', '--ends', 'ends.yaml'], 2, 'not allowed with argument'),
    (['run1.bag', 'D1R1_Odometry.dat'], 2, 'D1R1_Odometry.dat: a text file comes with its ground truth'),
    (['run1.bag', '--output', 'floor.txt'], 2, '--output: floor.txt: expected a file name with the extension .yaml'),
    (['run1.bag', '--output', 'no/floor.yaml'], 2, '--output: no/floor.yaml: expected a folder that exists'),
    (['run1.bag', '--plot', 'fit.doc'], 2, '--plot: fit.doc: expected a file name with one of the extensions '),
], ids=lambda value: ' '.join(value) if isinstance(value, list) else '')
def test_one_line_and_nothing_written(folder, arguments, status, text):
    before = sorted(os.listdir(str(folder)))
    output = [] if '--output' in arguments else ['--output', 'floor.yaml']
    actual, _, error = fit(folder, *arguments, *output)
    assert actual == status and text in error
    assert sorted(os.listdir(str(folder))) == before
