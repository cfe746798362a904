"""Finds the processes of a session by their HOME: nodes leave the terminal and the process group they start in."""
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
        except OSError:     # another user's, or gone
            pass
    return found


def kill(home):
    """Kill them, and wait until they are gone."""
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
