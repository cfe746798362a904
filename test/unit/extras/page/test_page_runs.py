"""The page and simulate.py compute the same runs, and the page receives the frames of the web view."""
import os
import subprocess
import sys

import pytest

from rbx1_nav.base.robot_parameters import load_robot
from rbx1_nav.base.surfaces import known_surfaces, load_surface
from rbx1_nav.exercise.methods import METHODS
from rbx1_nav.extras.many_runs.simulated_run import PARAMETERS, simulate
from page_runs import ROOT, SURFACES, request

TURTLEBOT = load_robot(os.path.join(ROOT, 'config', 'turtlebot.yaml'))


@pytest.mark.parametrize('surface', known_surfaces(SURFACES))
@pytest.mark.parametrize('method', METHODS)
def test_end_poses_are_those_of_simulate_py(method, surface):
    for seed in 7, 8, 2147483647:
        frame = request(method, surface, seed)[-1]
        end = simulate(method, TURTLEBOT, load_surface(surface, SURFACES), seed, filtered=True).end
        assert frame['poses'] == {'truth': list(end.truth), 'odometry': list(end.odometry),
                                  'estimate': list(end.estimate)}
        assert frame['time'] == pytest.approx(end.time - 2) and frame['status']['outcome'] == 'finished'


def test_other_speeds_and_distances():
    parameters = dict(linear_speed=0.3, goal_distance=0.7, angular_speed=0.9, goal_angle=2.0)
    frame = request('timed', 'low_ply_carpet', 5, **parameters)[-1]
    end = simulate('timed', TURTLEBOT, load_surface('low_ply_carpet', SURFACES), 5,
                   parameters={**PARAMETERS, **parameters}).end
    assert frame['poses']['truth'] == list(end.truth)


def test_frames_add_up_to_the_run():
    frames, whole = request('odom', 'low_ply_carpet', as_one_frame=False), request('odom', 'low_ply_carpet')
    times = [frame['time'] for frame in frames]
    assert times[0] == 0 and times == sorted(times)
    # 0.04 s, and the last frame at the end
    assert max(after - before for before, after in zip(times, times[1:])) == pytest.approx(0.04, abs=0.001)
    for group in 'paths', 'speeds':
        for name in whole[-1][group]:
            one, other = ([item for frame in each for item in frame.get(group, {}).get(name, [])]
                          for each in (frames, whole))
            assert one == other and len(one) > 50
    status = frames[0]['status']
    assert (status['surface'], status['seed'], status['started'], status['outcome']) == (
        'low_ply_carpet', '7', 'with odometry', '')


@pytest.mark.parametrize('method', ['timed', 'ekf'])
def test_stop(method):
    frames, whole = (request(method, 'low_ply_carpet', stop=stop, as_one_frame=False) for stop in (3.0, None))
    same = sum(frame['time'] <= 3.0 for frame in whole)
    assert frames[:same] == whole[:same]        # the run up to there, then the robot coasts
    assert frames[-1]['status']['outcome'] == 'stopped' and 3.02 < frames[-1]['time'] < 5.0
    assert 0.4 < frames[-1]['poses']['truth'][0] < 0.65


def test_a_run_is_cut_after_300_simulated_seconds():
    frame = request('timed', goal_distance=100.0)[-1]
    assert frame['status']['outcome'] == 'stopped, because 300 s have passed' and 300 <= frame['time'] < 301
    assert frame['poses']['truth'][0] == pytest.approx(60)      # at 0.2 m/s


def test_what_cannot_be_driven_is_in_the_log():
    frame = request('timed', goal_distance=0.001)[-1]
    assert frame['status']['outcome'] == 'failed; see the log' and 'goal_distance / linear_speed' in frame['log'][0][3]


def test_the_core_needs_neither_ros_nor_numpy_nor_yaml():
    code = ('import sys\n'
            'for name in "genpy", "numpy", "rosgraph", "rospkg", "rospy", "yaml":\n'
            '    sys.modules[name] = None\n'
            'import rbx1_nav.extras.page.runner\n')
    subprocess.run([sys.executable, '-c', code], check=True,
                   env={**os.environ, 'PYTHONPATH': os.path.join(ROOT, 'src')})
