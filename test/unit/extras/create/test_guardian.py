"""The guardian stops the robot when the guarded process has died or hangs. Real processes on a pseudo-terminal."""
import os
import signal
import subprocess
import sys
import time

import pytest

from rbx1_nav.extras.create import guardian
from rbx1_nav.extras.create.serial_port import PortError, open_port
from waiting import wait_for

STOP, COMMAND = b'\0\0\x91\0\0\0\0\x80', b'\x91'
LIMIT = 30      # s after which a wait fails

# a process that opens the port, starts a guardian, and sends heartbeats; it prints both process ids
GUARDED = '''
import sys, time
sys.path.insert(0, sys.argv[1])
from rbx1_nav.extras.create.guardian import Guardian
from rbx1_nav.extras.create.serial_port import open_port
port = open_port(sys.argv[2], 115200)
guardian = Guardian(port.fileno(), bytes.fromhex(sys.argv[3]))
port.write(bytes.fromhex(sys.argv[4]))
guardian.beat()
print(guardian.process.pid, flush=True)
while True:
    time.sleep(0.05)
    guardian.beat()
'''
GUARDIAN = guardian.__file__
SOURCE = os.path.join(os.path.dirname(__file__), '..', '..', '..', '..', 'src')


@pytest.fixture(name='start')
def make_start(terminal):
    """A function that returns (the guarded process, the process id of its guardian)."""
    processes = []

    def start():
        process = subprocess.Popen([sys.executable, '-c', GUARDED, SOURCE, terminal.link, STOP.hex(), COMMAND.hex()],
                                   stdout=subprocess.PIPE, start_new_session=True)
        processes.append(process)
        pid = int(process.stdout.readline())
        assert read_until(terminal, COMMAND) == COMMAND
        return process, pid
    yield start
    for process in processes:
        process.kill()
        process.wait()


def read_until(terminal, end):
    """Return the bytes that arrive at the robot, up to the bytes `end`."""
    data, give_up = b'', time.monotonic() + LIMIT
    while not data.endswith(end):
        assert time.monotonic() < give_up, data
        data += terminal.read()
        time.sleep(0.001)
    return data


def wait_for_end(pid):
    wait_for(lambda: not os.path.exists(f'/proc/{pid}'))


@pytest.mark.parametrize('end', [
    lambda process: process.kill(), lambda process: os.killpg(process.pid, signal.SIGKILL),
    lambda process: process.terminate()], ids=['kill', 'kill the group', 'terminate'])
def test_the_end_of_the_process_sends_the_stop(terminal, start, end):
    process, pid = start()
    for number in signal.SIGINT, signal.SIGTERM, signal.SIGHUP, signal.SIGTSTP:     # as killall sends them
        os.kill(pid, number)
    end(process)
    assert read_until(terminal, STOP) == STOP
    process.communicate()
    wait_for_end(pid)
    open_port(terminal.link, 115200).close()


def test_a_process_that_hangs_is_stopped_once(terminal, start):
    process, pid = start()
    process.send_signal(signal.SIGSTOP)
    assert read_until(terminal, STOP) == STOP
    process.send_signal(signal.SIGCONT)
    process.kill()
    assert read_until(terminal, STOP) == STOP
    process.communicate()
    wait_for_end(pid)


def test_the_port_is_in_use_until_the_stop_is_sent(terminal, start):
    process, pid = start()
    os.kill(pid, signal.SIGSTOP)
    process.kill()
    process.communicate()
    with pytest.raises(PortError) as caught:
        open_port(terminal.link, 115200)
    assert 'in use by another process' in str(caught.value)
    os.kill(pid, signal.SIGCONT)
    assert read_until(terminal, STOP) == STOP


def test_a_process_that_dies_while_its_guardian_starts_is_stopped_too(terminal):
    """The pipe on which the guardian reports its start is broken by then."""
    with open_port(terminal.link, 115200) as port:
        read_end, write_end = os.pipe()
        os.close(read_end)
        process = subprocess.Popen([sys.executable, '-E', '-S', GUARDIAN, str(port.fileno()), STOP.hex()],
                                   stdin=subprocess.DEVNULL, stdout=write_end, pass_fds=(port.fileno(),))
        os.close(write_end)
        assert read_until(terminal, STOP) == STOP
        assert process.wait() == 0


def test_a_cable_that_is_gone_ends_the_guardian(terminal, start):
    process, pid = start()
    terminal.unplug()
    process.kill()
    process.communicate()
    wait_for_end(pid)
