"""Processes: start commands, measure a process with all its children, stop all of them. Linux only (/proc)."""
import ctypes
import os
import signal
import subprocess
import time

TICK = os.sysconf('SC_CLK_TCK')


def adopt_orphans():
    """Make this process the parent of every orphan below it, so that it can stop everything that it has started."""
    ctypes.CDLL(None).prctl(36, 1, 0, 0, 0)  # 36: PR_SET_CHILD_SUBREAPER of linux/prctl.h


def start(command, environment, log):
    """Start a shell command in a separate session, so that Ctrl-C in the terminal does not reach it."""
    with open(log, 'wb') as output:
        return subprocess.Popen(command, shell=True, env=environment, stdin=subprocess.DEVNULL, stdout=output,
                                stderr=subprocess.STDOUT, start_new_session=True)


def stop(process, timeout=5):
    """Send SIGINT to a started command; returns whether it exits within `timeout` (s)."""
    if process.poll() is None:
        os.killpg(process.pid, signal.SIGINT)
    try:
        process.wait(timeout)
    except subprocess.TimeoutExpired:
        return False
    return True


def kill_rest():
    """Kill every process below this one."""
    while True:
        rest = tree([os.getpid()]) - {os.getpid()}
        if not rest:
            return
        for pid in rest:
            try:
                if stat(pid)[0] != b'Z':
                    os.kill(pid, signal.SIGKILL)
                os.waitpid(pid, os.WNOHANG)
            except (OSError, ValueError):
                pass  # it has exited, or is not yet a child of this process: the next round checks again
        time.sleep(0.01)


def stat(pid):
    """The fields of /proc/<pid>/stat, starting with the state: item 0 is field 3 of proc(5)."""
    with open(f'/proc/{pid}/stat', 'rb') as file:
        return file.read().rpartition(b')')[2].split()


def tree(roots):
    """These processes and all their descendants, as a set."""
    children = {}
    for name in os.listdir('/proc'):
        if name.isdigit():
            try:
                children.setdefault(int(stat(name)[1]), []).append(int(name))
            except OSError:
                pass  # it has just exited
    found, new = set(), list(roots)
    while new:
        pid = new.pop()
        found.add(pid)
        new += children.get(pid, [])
    return found


def sample(roots):
    """(monotonic time in s, CPU time so far in s, resident memory in bytes) of the processes and all their children."""
    cpu = resident = 0
    now = time.monotonic()
    for pid in tree(roots):
        try:
            # utime and stime, and cutime and cstime of children that have exited
            cpu += sum(int(field) for field in stat(pid)[11:15])
            resident += memory(pid, 'status', 'VmRSS')
        except OSError:
            pass
    return now, cpu / TICK, resident


def proportional(roots):
    """The proportional set size (bytes) of the processes and all their children; None if it cannot be read."""
    try:
        return sum(memory(pid, 'smaps_rollup', 'Pss') for pid in tree(roots))
    except OSError:
        return None


def memory(pid, file, key):
    """The value (bytes) of one 'Key:  N kB' line of a file in /proc/<pid>; 0 if there is none."""
    with open(f'/proc/{pid}/{file}') as lines:
        for line in lines:
            if line.startswith(f'{key}:'):
                return 1024 * int(line.split()[1])
    return 0
