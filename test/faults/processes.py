"""What /proc says about the processes of a fault: found by a variable in their environment."""
import os
import time


def with_variable(name, value):
    """The ids of all processes that have this environment variable, except zombies, sorted."""
    found = []
    for pid in filter(str.isdigit, os.listdir('/proc')):
        try:
            with open('/proc/%s/environ' % pid, 'rb') as file:      # empty for a zombie
                if ('%s=%s' % (name, value)).encode() in file.read().split(b'\0'):
                    found.append(int(pid))
        except OSError:     # it has ended, or is somebody else's
            pass
    return sorted(found)


def commands(pids):
    """The command lines of processes, as text."""
    texts = []
    for pid in pids:
        try:
            with open('/proc/%d/cmdline' % pid, 'rb') as file:
                texts.append('%d %s' % (pid, file.read().replace(b'\0', b' ').decode(errors='replace')[:160]))
        except OSError:
            pass
    return '\n'.join(texts)


def wait_for_end(find, limit):
    """Wait until find() has no processes any more; returns how long that took, s. Raises AssertionError."""
    start = time.monotonic()
    while True:
        pids = find()
        if not pids:
            return time.monotonic() - start
        assert time.monotonic() < start + limit, 'still there after %g s:\n%s' % (limit, commands(pids))
        time.sleep(0.02)
