#!/usr/bin/env python3
"""Connect clients to the web view that read every frame, as browsers do, and run a command meanwhile. See README.md."""
import argparse
import os
import subprocess
import sys
import threading

sys.path.append(os.path.join(os.path.dirname(os.path.realpath(__file__)), '..', 'test', 'faults'))

from web_client import WebClient


def read(port, ready):
    """Read frames without end. ready: an Event that is set at the first frame."""
    client = WebClient(port, token='')
    client.wait_for('frame')
    ready.set()
    while True:
        client.next()


def main():
    """Returns the exit status of the command."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument('count', type=int, help='number of clients; at most 60 may connect without the token')
    parser.add_argument('command', nargs=argparse.REMAINDER, metavar='COMMAND', help='shell command')
    parser.add_argument('--port', type=int, default=8080, help='port of the web view; default: 8080')
    arguments = parser.parse_args()
    ready = [threading.Event() for _ in range(arguments.count)]
    readers = [threading.Thread(target=read, args=(arguments.port, each), daemon=True) for each in ready]
    for reader in readers:
        reader.start()
    if not all(each.wait(30) for each in ready):
        sys.exit(f'browsers: not all of {arguments.count} clients have received a frame')
    status = subprocess.call(' '.join(arguments.command), shell=True)
    if not all(reader.is_alive() for reader in readers):    # one ends only with an error
        sys.exit('browsers: not all clients have read to the end')
    return status


if __name__ == '__main__':
    sys.exit(main())
