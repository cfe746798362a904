"""Processes: start commands, measure a process with all its children, and leave none behind. Linux only (/proc)."""
import ctypes
import os
import signal
import subprocess
import time

TICK = os.sysconf('SC_CLK_TCK')


def adopt_orphans():
    """Make this process the parent of every orphan below it, so that nothing it started can escape it."""
    ctypes.CDLL(None).prctl(36, 1, 0, 0, 0)  # 36: PR_SET_CHILD_SUBREAPER of linux/prctl.h


def start(command, environment, log):
    """Run a shell command in a session of its own, where a Ctrl-C at our terminal does not reach it."""
    with open(log, 'wb') as output:
        return subprocess.Popen(command, shell=True, env=environment, stdin=subprocess.DEVNULL, stdout=output,
                                stderr=subprocess.STDOUT, start_new_session=True)


def stop(process, patience=5):
    """Ctrl-C for a started command, and patience (s) for it to end; whether it did."""
    if process.poll() is None:
        os.killpg(process.pid, signal.SIGINT)
    try:
        process.wait(patience)
    except subprocess.TimeoutExpired:
        return False
    return True


def kill_rest():
    """Kill every process below this one that is still there; their number."""
    killed = set()
    while True:
        rest = tree([os.getpid()]) - {os.getpid()}
        if not rest:
            return len(killed)
        for pid in rest:
            try:
                if stat(pid)[0] != b'Z':
                    os.kill(pid, signal.SIGKILL)
                    killed.add(pid)
                os.waitpid(pid, os.WNOHANG)
            except (OSError, ValueError):
                pass  # gone meanwhile, or not yet ours to wait for: the next round sees
        time.sleep(0.01)


def stat(pid):
    """The fields of /proc/<pid>/stat from the state on (field 3 of proc(5) is item 0)."""
    with open(f'/proc/{pid}/stat', 'rb') as file:
        return file.read().rpartition(b')')[2].split()


def tree(roots):
    """The set of these processes and all that descend from them."""
    children = {}
    for name in os.listdir('/proc'):
        if name.isdigit():
            try:
                children.setdefault(int(stat(name)[1]), []).append(int(name))
            except OSError:
                pass  # it ended while we looked
    found, new = set(), list(roots)
    while new:
        pid = new.pop()
        found.add(pid)
        new += children.get(pid, [])
    return found


def sample(roots):
    """(monotonic time, CPU seconds used so far, resident bytes) of the processes and all their children together."""
    cpu = resident = 0
    now = time.monotonic()
    for pid in tree(roots):
        try:
            # utime, stime, and those of children that ended (cutime, cstime)
            cpu += sum(int(field) for field in stat(pid)[11:15])
            resident += memory(pid, 'status', 'VmRSS')
        except OSError:
            pass
    return now, cpu / TICK, resident


def proportional(roots):
    """Proportional set size (bytes) of the processes and all their children; None where it may not be read."""
    try:
        return sum(memory(pid, 'smaps_rollup', 'Pss') for pid in tree(roots))
    except OSError:
        return None


def memory(pid, file, key):
    """The value (bytes) of one 'Key:  N kB' line of a file in /proc/<pid>; 0 if it has none."""
    with open(f'/proc/{pid}/{file}') as lines:
        for line in lines:
            if line.startswith(key + ':'):
                return 1024 * int(line.split()[1])
    return 0
