"""Finds the processes of a session by their HOME, because nodes leave their terminal and their process group."""
import os
import signal
import time


def find(home):
    """{process id: command line} of all processes with this HOME in their environment."""
    mark, found = b'HOME=' + home.encode(), {}
    for pid in filter(str.isdigit, os.listdir('/proc')):
        try:
            with open(f'/proc/{pid}/environ', 'rb') as file:
                ours = mark in file.read().split(b'\0')
            with open(f'/proc/{pid}/cmdline', 'rb') as file:
                if ours:
                    found[int(pid)] = file.read().replace(b'\0', b' ').decode(errors='replace')
        except OSError:     # another user's process, or it has exited
            pass
    return found


def kill(home):
    """Kill all processes with this HOME, and wait until they have exited."""
    while True:
        found = find(home)
        for pid in found:
            try:
                os.kill(pid, signal.SIGKILL)
            except ProcessLookupError:
                pass
        if not found:
            return
        time.sleep(0.01)
