"""Processes started by the scripts stop with them, and have SIGINT's default action."""
import os
import re
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
    needed = words_of('dependencies exec; printf "%s\n" "${tool_packages[@]}"') - {'qt6-svg-plugins'}
    commands = words_of('printf "%s\n" "${command_packages[@]}"') - {'rosbash', 'rospack-tools'}
    assert named == needed - commands | {'ros-robot'}
