"""A run is a process of its own, one at a time, and is stopped as Ctrl-C does it."""
import os
import signal
import subprocess
import sys

import pytest

from rbx1_nav.exercise.methods import METHODS
from rbx1_nav.extras.web import page_runs as module
from rbx1_nav.extras.web.page_runs import Runs
from waiting import wait_for

SOURCE = os.path.join(os.path.dirname(__file__), '..', '..', '..', '..', 'src')
SCRIPT = '''#!{python}
import os, signal, sys, time
def stop(*_):
    sys.exit(130)
signal.signal(signal.SIGINT, {handler})
with open(sys.argv[1], 'w') as file:     # Python ignores an exception from a signal in the close of a lost file
    file.write(str(os.getpid()))
while not os.path.exists(sys.argv[1] + '.end'):
    time.sleep(0.01)
sys.exit({status})
'''


@pytest.fixture(name='started')
def make(tmp_path, monkeypatch):
    """Runs, and what it reports. make(...) writes the script."""
    changes = []
    runs = Runs(str(tmp_path), lambda *change: changes.append(change), lambda: None)
    pid_file = tmp_path / 'pid'

    def write(handler='stop', status=0):
        script = tmp_path / 'script.py'
        script.write_text(SCRIPT.format(python=sys.executable, handler=handler, status=status))
        script.chmod(0o755)
    write()
    monkeypatch.setattr(module, 'METHODS', {'timed': METHODS['timed']._replace(
        script='script.py', arguments=(str(pid_file),))})
    yield runs, changes, pid_file, write
    runs.stop()
    wait_for(lambda: not runs.busy)


def begun(pid_file):
    return pid_file.exists() and pid_file.read_text()


def test_a_run(started):
    runs, changes, pid_file, _ = started
    assert runs.start('timed', lambda _: None)
    wait_for(lambda: begun(pid_file))
    assert runs.busy and not runs.start('timed', lambda _: None)
    (pid_file.parent / 'pid.end').touch()
    wait_for(lambda: not runs.busy)
    wait_for(lambda: changes == [('timed', ''), ('timed', 'finished')])


@pytest.mark.parametrize('handler, timeout', [('stop', module.STOP_TIMEOUT), ('signal.SIG_IGN', 0.1)])
def test_a_run_is_stopped_and_killed_if_it_hangs(started, monkeypatch, handler, timeout):
    runs, changes, pid_file, write = started
    monkeypatch.setattr(module, 'STOP_TIMEOUT', timeout)
    write(handler=handler)
    runs.start('timed', lambda _: None)
    wait_for(lambda: begun(pid_file))
    runs.stop()
    wait_for(lambda: changes[1:] == [('timed', 'stopped')])


def test_a_run_ends_with_a_view_that_is_killed(started):
    runs, _, pid_file, _ = started
    code = ('import sys, time; sys.path.insert(0, sys.argv[1])\n'
            'from rbx1_nav.extras.web import page_runs as runs\n'
            'timed = runs.METHODS["timed"]._replace(script="script.py", arguments=(sys.argv[3],))\n'
            'runs.METHODS = {"timed": timed}\n'
            'runs.Runs(sys.argv[2], lambda *_: None, lambda: None).start("timed", lambda _: None)\n'
            'time.sleep(600)')
    with subprocess.Popen([sys.executable, '-c', code, SOURCE, runs.folder, str(pid_file)]) as view:
        wait_for(lambda: begun(pid_file))
        pid = int(pid_file.read_text())
        view.send_signal(signal.SIGKILL)
    wait_for(lambda: not os.path.exists(f'/proc/{pid}') or b') Z ' in open(f'/proc/{pid}/stat', 'rb').read())
