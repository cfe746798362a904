"""simulate.py prints a table, writes the files that it is asked for, and rejects what it cannot simulate."""
from concurrent.futures.process import BrokenProcessPool
import csv
import os
import re
import signal

import pytest

from rbx1_nav.extras.many_runs import sweep
from rbx1_nav.extras.many_runs.sweep import Sweep
from loaded_nodes import ROOT, load, run_program


@pytest.fixture(name='simulate')
def fixture_simulate(monkeypatch, tmp_path):
    """Runs simulate.py in a folder of its own; simulate.handlers: of the signals."""
    def simulate(*arguments):
        return run_program(monkeypatch, tmp_path, load('simulate'), '--jobs', '1', *arguments)
    simulate.handlers = {}
    monkeypatch.setattr(signal, 'signal', simulate.handlers.__setitem__)
    monkeypatch.chdir(tmp_path)
    return simulate


def test_files_and_tables_of_a_sweep(simulate):
    status, out, err = simulate(
        '--runs', '2', '--seed', '5', '--method', 'odom', '--method', 'timed', '--method', 'odom', '--surface', 'ideal',
        '--surface', 'low_ply_carpet', '--surface', 'ideal', '--set', 'goal_distance=0.3,0.4', '--output', 'runs.csv')
    assert (status, err) == (0, '') and out.startswith('2 runs of each method on each of 4 combinations, seeds 5 to 6.')
    assert [line for line in out.splitlines() if line.endswith(':') and 'goal_distance' in line] == [
        f'{floor}, goal_distance {each}:' for floor in ('ideal', 'low_ply_carpet') for each in (0.3, 0.4)]
    with open('runs.csv') as file:
        rows = list(csv.DictReader(file))
    assert len(rows) == 16 and {each['seed'] for each in rows} == {'5', '6'} and 'goal_distance (m)' in rows[0]
    assert [each['method'] for each in rows[:4]] == ['odom', 'odom', 'timed', 'timed'] and len(out.splitlines()) > 20


def test_pictures_and_a_file_of_the_robot(simulate, tmp_path):
    with open(os.path.join(ROOT, 'config', 'turtlebot.yaml')) as file:
        (tmp_path / 'robot.yaml').write_text(file.read().replace('Ko: 50', 'wings: 2'))
    status, out, err = simulate(
        '--runs', '1', '--seed', '2147483647', '--method', 'timed', '--set', 'goal_distance=0.2', '--plot', 'ends.png',
        '--animate', 'run.gif', '--config', 'robot.yaml')
    assert (status, err) == (0, 'simulate.py: ignoring unknown parameters: controllers/base_controller/wings\n')
    assert os.path.getsize('ends.png') and os.path.getsize('run.gif') and '/odom_ekf' not in out
    assert out.splitlines()[-2:] == ['Picture: ends.png', 'Animation: run.gif']
    assert out.startswith('1 run of each method on ideal, goal_distance 0.2, seed 2147483647.')


def test_without_a_terminal_lines_show_rate_and_time_left(simulate, monkeypatch):
    monkeypatch.setattr(sweep, 'MOMENT', 0.0)       # any command is long
    monkeypatch.setattr(sweep, 'REPORT', 0.0)
    command = '--runs', '2', '--method', 'odom', '--method', 'timed', '--surface', 'ideal', '--output', 'runs.csv'
    assert simulate(*command)[0] == 0
    with open('runs.csv', 'r+') as file:
        file.truncate(len(''.join(file.readlines()[:3])))       # two of four runs
    status, _, err = simulate(*command)
    assert status == 0 and re.fullmatch(r'timed: 100% 4/4 \[00:00<00:00, +[0-9.]+run/s\]\n', err), err


@pytest.mark.parametrize('arguments, status, text', [
    (['--runs', '0'], 2, '--runs: 0: expected an integer from 1 to 1000000'), (['--runs', '1000001'], 2, '--runs: 10'),
    (['--jobs', '0'], 2, '--jobs: 0: expected an integer from 1 to 1000000'), (['--jobs', '1000001'], 2, '--jobs: 10'),
    (['--seed', '-1'], 2, '--seed: -1: expected an integer from 0 to 21474835'), (['--method', 'luck'], 2, 'luck'),
    (['--runs', '2', '--seed', '2147483647'], 2, '--seed: 2147483647: expected an integer from 0 to 2147483646'),
    (['--plot', 'ends.txt'], 2, '--plot: ends.txt: exp'), (['--animate', 'run.pdf'], 2, '--animate: run.pdf: exp'),
    (['--surface', 'sand'], 1, "simulate.py: surface: 'sand': expected one of"), (['--set', 'luck=1'], 1, 'luck'),
    (['--surface', 'sand.yaml'], 1, f'{os.sep}sand.yaml'),
    (['--set', 'goal_distance=1,2', '--plot', 'run.png'], 1, '--plot: expected one combination, not 2'),
    (['--set', 'goal_distance=1,2', '--animate', 'run.gif'], 1, '--animate: expected one combination, not 2')])
def test_what_is_rejected(simulate, arguments, status, text):
    found, out, err = simulate(*arguments)
    assert (found, out) == (status, '') and text in err.splitlines()[-1] and 'Traceback' not in err


@pytest.mark.parametrize('event, text', [
    (BrokenProcessPool(), 'a process was killed, perhaps because memory ran out: expected all of --jobs 1 to run'),
    (OSError('no\n space'), 'no space'), (signal.SIGINT, 'interrupted: '), (signal.SIGTERM, 'interrupted: ')])
def test_an_end_in_a_run_says_what_the_file_lacks(simulate, monkeypatch, event, text):
    def run(sweep, *_):
        sweep.done = 2
        if not isinstance(event, Exception):
            simulate.handlers[event]()
        raise event
    monkeypatch.setattr(Sweep, 'run', run)
    monkeypatch.setattr(os, '_exit', lambda status: (_ for _ in ()).throw(SystemExit(status)))
    lacks = simulate('--runs', '3', '--method', 'timed', '--output', 'runs.csv')
    if isinstance(event, Exception):
        assert lacks[::2] == (1, f'simulate.py: {text}; runs.csv lacks 1 of 3 runs\n')
        assert simulate('--runs', '3')[::2] == (1, f'simulate.py: {text}\n')
    else:
        assert lacks[::2] == (130, f'simulate.py: {text}runs.csv lacks 1 of 3 runs\n')
        assert simulate('--runs', '3')[::2] == (130, '')
