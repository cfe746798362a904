"""The information of the kernel about other processes, tested with real processes."""
import os
import signal
import socket
import subprocess
from types import SimpleNamespace

import pytest

from rbx1_nav.extras.lockstep.processes import Process, find_awake, polling, still_polling
from waiting import wait_for

BEGIN = 'import socket, sys, threading, time\nprint("up", flush=True)\n'
POLL = 'def poll():\n    while True: time.sleep(0.001)\nthreading.Thread(target=poll, daemon=True).start()\n'


@pytest.fixture(name='start')
def make_start():
    """Return start(code), which starts a process that runs Python code, and waits until it is running."""
    children = []

    def start(code):
        child = subprocess.Popen(['/usr/bin/python3', '-c', BEGIN + code],
                                 stdin=subprocess.PIPE, stdout=subprocess.PIPE)
        children.append(child)
        child.stdout.readline()
        return child
    yield start
    for child in children:
        child.kill()
        child.communicate()


def polling_process(child):
    """Return the Process of a child whose code begins with POLL."""
    process = Process(child.pid)
    wait_for(lambda: process.sleeps() and len(process.threads) == 2)
    for thread in process.threads.values():
        thread.is_poller = thread is not process.main
    return process


def fake(activity=lambda _: 0, sleeps=lambda: True, polls=False):
    """Return something like a Process."""
    return SimpleNamespace(activity=activity, sleeps=sleeps, ended=lambda: False, has_pollers=lambda: polls)


@pytest.mark.parametrize('polls', [False, True])
def test_what_has_been_woken_is_awake_until_it_has_answered(start, polls):
    """The simulated clock relies on this: no answer comes from a process that was asleep."""
    with socket.socket() as server:
        server.bind(('127.0.0.1', 0))
        server.listen()
        child = start(POLL * polls + 's = socket.create_connection(("127.0.0.1", %d))\n'
                      'while s.recv(1): sum(range(1000)); s.send(b"x")' % server.getsockname()[1])
        connection, _ = server.accept()
        with connection:
            watched = [Process(child.pid)]
            if polls:
                watched = [polling_process(child), *(polling_process(start(POLL + 'sys.stdin.read()')) for _ in '12')]
            for _ in range(2000):
                connection.send(b'x')
                while find_awake(watched):
                    pass
                assert connection.recv(1, socket.MSG_DONTWAIT) == b'x'


def test_a_thread_that_polls_need_not_be_waited_for(start):
    child = start(POLL + 'sys.stdin.readline(); sys.stdin.read()')
    process = polling_process(child)
    wait_for(lambda: not find_awake([process]))
    rest, total = process.activity(True), process.activity(False)
    wait_for(lambda: process.activity(False) != total)
    assert process.activity(True) == rest
    child.stdin.write(b'\n')
    child.stdin.flush()
    wait_for(lambda: process.activity(True) != rest)


def test_a_stopped_process_has_not_finished(start):
    child = start('sys.stdin.read()')
    process = Process(child.pid)
    wait_for(lambda: not find_awake([process]))
    child.send_signal(signal.SIGSTOP)
    wait_for(lambda: find_awake([process]))
    for _ in range(100):
        assert find_awake([process]) is process
    child.send_signal(signal.SIGCONT)
    wait_for(lambda: not find_awake([process]))


def test_a_process_that_has_ended_counts_as_asleep(start):
    child = start('sys.stdin.read()')
    process = Process(child.pid)
    child.kill()
    wait_for(lambda: not find_awake([process]))
    child.wait()
    assert not find_awake([process]) and not polling([process])
    with pytest.raises(OSError):
        Process(child.pid)


def test_a_thread_that_takes_the_place_of_another_one_is_watched(start):
    """As in this node, of which one thread is not watched: the number of threads stays the same."""
    child = start('def first():\n    sys.stdin.readline()\n    threading.Thread(target=second).start()\n'
                  'def second():\n    while True: pass\n'
                  'threading.Thread(target=first).start()\nthreading.Event().wait()')
    folder = f'/proc/{child.pid}/task/'
    before = wait_for(lambda: len(found := os.listdir(folder)) == 2 and found)
    process = Process(child.pid, child.pid)
    wait_for(lambda: not find_awake([process]))
    child.stdin.write(b'\n')
    child.stdin.flush()
    wait_for(lambda: len(found := os.listdir(folder)) == 2 and found != before)
    for _ in range(20):
        assert find_awake([process]) is process


def test_a_thread_that_polls(start):
    process = Process(start('while True: time.sleep(0.001)').pid)
    threads = wait_for(lambda: polling([process]))
    wait_for(lambda: not still_polling(threads))
    sleeper = Process(start('time.sleep(1000)').pid)
    wait_for(lambda: not find_awake([sleeper]))
    wait_for(lambda: not polling([sleeper]))
    # a process that waits for a message does not poll, even if it has just run
    reader = start('for line in sys.stdin: print("read", flush=True)')
    process = Process(reader.pid)
    for _ in range(20):
        reader.stdin.write(b'\n')
        reader.stdin.flush()
        reader.stdout.readline()
        wait_for(lambda: not find_awake([process]))
        assert not polling([process])


def test_messages_in_transit(start):
    child = start('for line in sys.stdin: print("read", flush=True)')
    process = Process(child.pid)

    def run_and_sleep():
        child.stdin.write(b'\n')
        child.stdin.flush()
        child.stdout.readline()
        wait_for(lambda: not find_awake([process]))
        return False
    wait_for(lambda: not find_awake([process]))
    assert not find_awake([process], SimpleNamespace(busy=lambda: False))
    network = SimpleNamespace(busy=lambda: True)
    assert find_awake([process], network) is network
    # it may have sent a message after the network was checked
    assert find_awake([process], SimpleNamespace(busy=run_and_sleep)) is process


def test_a_process_that_has_run_between_two_looks_is_awake():
    """A process was asleep when it was checked, but perhaps not at the same moment as the others."""
    times = iter([1, 2])
    process = fake(lambda _: next(times))
    assert find_awake([process]) is process
    times = iter([1, 1])
    assert find_awake([process]) is None


def test_a_process_that_ran_while_another_one_was_looked_at_is_awake():
    times = [5]
    sender = fake(lambda _: times[-1])
    # it is asleep when it is checked; then the sender wakes it, and is itself asleep when it is checked
    woken = fake(sleeps=lambda: times.append(6) is None)
    assert find_awake([woken, sender]) is sender


def test_what_a_thread_that_polls_has_woken_after_its_check_is_awake():
    asleep = iter([True, False])
    woken = fake(sleeps=lambda: next(asleep))
    assert find_awake([woken, *(fake(polls=True) for _ in '123')]) is woken
