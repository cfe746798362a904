"""Processes started by the scripts stop with them, and have SIGINT's default action."""
import os
import re
import shutil
import signal
import subprocess
import time

import pytest

COMMON = os.path.realpath(os.path.join(os.path.dirname(__file__), '..', '..', 'script', 'common.sh'))
LIMIT = 60      # s


@pytest.fixture
def start(tmp_path):
    """start(text, **options): start a script that sources common.sh; options: for subprocess.Popen."""
    started = []

    def make(text, **options):
        path = tmp_path / f'script{len(started)}'
        path.write_text(f'set -euo pipefail\nsource {COMMON}\n{text}\n')
        started.append(subprocess.Popen(['bash', str(path)], stdout=subprocess.PIPE, text=True, **options))
        return started[-1]
    yield make
    for process in started:
        process.kill()
        process.wait()
        process.stdout.close()


def obey_sighup():
    """Restore the default action of SIGHUP: what nohup starts ignores it, and so do all its children."""
    signal.signal(signal.SIGHUP, signal.SIG_DFL)


@pytest.mark.parametrize('number', [signal.SIGINT, signal.SIGTERM, signal.SIGHUP])
def test_a_signal_ends_what_a_script_has_started(start, tmp_path, number):
    node = f'ROS_HOME={tmp_path}/ros setsid sleep 1000'
    script = start(f"""trap 'end_all {tmp_path}' EXIT
        trap 'exit 143' INT TERM HUP
        ({node} & echo $!)
        run bash -c 'echo $$; exec sleep 1000'""", preexec_fn=obey_sighup)
    pids = [int(script.stdout.readline()) for _ in range(2)]
    script.send_signal(number)
    assert script.wait(LIMIT) == 143
    end = time.monotonic() + LIMIT
    while any(map(is_alive, pids)):
        assert time.monotonic() < end, 'a process is left'
        time.sleep(0.01)


def test_a_signal_ends_the_unit_tests(tmp_path):
    # a copy of script/unit with a single test, which is new and therefore runs first, and tells its process id
    root = os.path.join(os.path.dirname(COMMON), '..')
    shutil.copytree(os.path.join(root, 'script'), tmp_path / 'script')
    shutil.copy(os.path.join(root, 'package.xml'), tmp_path)
    for test in ('test_rooms.py', 'pages/test_parameter_tables.py'):
        path = tmp_path / 'test' / 'unit' / test
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text('import os, sys, time\nprint(os.getpid(), file=sys.__stdout__, flush=True)\ntime.sleep(1000)\n')
    subprocess.run(['git', 'init', '-q', tmp_path], check=True)
    script = subprocess.Popen(['bash', tmp_path / 'script' / 'unit', '-s'], stdout=subprocess.PIPE, text=True)
    pid = int(script.stdout.readline())
    script.terminate()
    assert script.wait(LIMIT) == -signal.SIGTERM
    end = time.monotonic() + LIMIT
    while is_alive(pid):
        assert time.monotonic() < end, 'pytest is left'
        time.sleep(0.01)
    script.stdout.close()


def is_alive(pid):
    """Whether a process is running; one that has exited may still exist as a zombie."""
    try:
        with open(f'/proc/{pid}/stat', encoding='ascii') as file:
            return file.read().rpartition(')')[2].split()[0] != 'Z'
    except FileNotFoundError:
        return False


def words_of(command):
    """The output of a bash command, with common.sh sourced, as a set of words."""
    script = f'set -euo pipefail; source {COMMON}; {command}'
    return set(subprocess.run(['bash', '-c', script], stdout=subprocess.PIPE, text=True, check=True).stdout.split())


def test_the_installation_page_names_the_packages_that_the_scripts_install():
    page = os.path.join(os.path.dirname(COMMON), '..', 'docs', 'installation.md')
    with open(page, encoding='utf-8') as file:
        command = re.search(r'sudo apt-get install (ros-robot(?:.*\\\n)*.*)', file.read())[1]
    named = set(command.replace('\\\n', ' ').split())
    # ros-robot depends on ros-core
    needed = words_of('dependencies exec; printf "%s\n" "${tool_packages[@]}"') - {'ros-core', 'qt6-svg-plugins'}
    assert named == needed | {'ros-robot'}
