#!/usr/bin/env python3
"""Starts a ROS master, a simulated TurtleBot and its page in the browser for each of several learners on this machine.

Prints the address of each page, which contains the token of the seat, and the ROS_MASTER_URI for terminals of the
learner. Ctrl-C stops all seats.
"""
import rbx1_nav.ros.node.early_interrupt     # first, so that Ctrl-C during the other imports exits quietly

import argparse
import re
import signal
import socket
import subprocess
import sys
import threading
import time

START_TIMEOUT, STOP_TIMEOUT = 60.0, 20.0    # s for a seat to start, and for all seats to stop
MAX_SEATS = 100
COLOR = re.compile('\x1b\\[[0-9;]*m')


class Seat:
    """A roslaunch process with its own master."""

    def __init__(self, number, arguments):
        """arguments: from the command line."""
        self.number = number
        self.master_port = arguments.master_port + number
        self.web_port = arguments.web_port + number
        self.command = ['roslaunch', '-p', str(self.master_port), 'rbx1_nav', 'fake_turtlebot.launch', 'web:=true',
                        f'web_address:={arguments.address}', f'web_port:={self.web_port}', 'model:=none',
                        *arguments.launch]
        self.process = None
        self.page = ''
        self.lines = []     # the last ones of its output
        self.ready = threading.Event()      # when base and page are ready, or the process has exited

    def start(self):
        """Start the process. Returns whether base and page are ready."""
        # it gets SIGINT when this process exits, however it exits; and Ctrl-C in the terminal reaches only this process
        self.process = subprocess.Popen(['setpriv', '--pdeathsig', 'INT', *self.command], stdin=subprocess.DEVNULL,
                                        stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True,
                                        start_new_session=True)
        threading.Thread(target=self.read, daemon=True).start()
        self.ready.wait(START_TIMEOUT)
        return bool(self.page) and self.process.poll() is None

    def read(self):
        """Read the output until the process exits."""
        base_ready = False
        for line in self.process.stdout:
            self.lines = [*self.lines[-19:], COLOR.sub('', line).strip('=\n')]
            self.page = self.page or ''.join(re.findall(r'Open (http\S+)', line))
            base_ready = base_ready or 'Ready: ' in line
            if self.page and base_ready:
                self.ready.set()
        self.ready.set()

    def stop(self):
        """Stop the process as Ctrl-C does; does not wait."""
        if self.process and self.process.poll() is None:
            self.process.send_signal(signal.SIGINT)

    def error(self):
        """Return the last error in the output, or the last line."""
        errors = [line for line in self.lines if re.search('ERROR|FATAL|Exception|REQUIRED', line)]
        return (errors or self.lines or ['no output'])[-1]


def read_arguments():
    """Return the checked command-line arguments."""
    parser = argparse.ArgumentParser(description=__doc__.split('\n')[0])
    parser.add_argument('seats', type=int, help=f'number of seats, 1 to {MAX_SEATS}')
    parser.add_argument('launch', nargs='*', metavar='ARGUMENT:=VALUE',
                        help='argument of fake_turtlebot.launch, such as surface:=low_ply_carpet')
    parser.add_argument('--address', default='localhost',
                        help='where the pages are served; default: localhost, for this machine only')
    parser.add_argument('--master-port', type=int, default=11311, metavar='PORT',
                        help='seat N has its master at this port plus N; default: 11311')
    parser.add_argument('--web-port', type=int, default=8080, metavar='PORT',
                        help='seat N has its page at this port plus N; default: 8080')
    arguments = parser.parse_intermixed_args()
    if not 1 <= arguments.seats <= MAX_SEATS:
        parser.error(f'seats: {arguments.seats}: expected an integer from 1 to {MAX_SEATS}')
    for name in 'master_port', 'web_port':
        if not 1024 <= getattr(arguments, name) <= 65535 - MAX_SEATS:
            parser.error(f"--{name.replace('_', '-')}: {getattr(arguments, name)}: expected 1024 to "
                         f'{65535 - MAX_SEATS}')
    for each in arguments.launch:
        if ':=' not in each:
            parser.error(f'{each}: expected argument:=value')
    return arguments


def used_port(seats):
    """Return a port of a seat that another program uses, or None."""
    for port in [port for seat in seats for port in (seat.master_port, seat.web_port)]:
        with socket.socket() as test:
            test.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
            try:
                test.bind(('', port))
            except OSError:
                return port
    return None


def run(seats):
    """Start the seats, and report those that exit. Returns 1 when none is left."""
    print('seat  ROS_MASTER_URI            page')
    for seat in seats:
        if not seat.start():
            sys.exit(f'seat {seat.number}: not started: {seat.error()}')
        print(f'{seat.number:4}  http://localhost:{seat.master_port:<7} {seat.page}')
    print(f'Ready: {len(seats)} seats. Ctrl-C stops them')
    running = set(seats)
    while running:
        for seat in [each for each in running if each.process.poll() is not None]:
            running.remove(seat)
            print(f'seat {seat.number}: exited: {seat.error()}', file=sys.stderr)
        time.sleep(0.5)
    return 1


def main():
    """Run until Ctrl-C; return the exit status."""
    arguments = read_arguments()
    seats = [Seat(number, arguments) for number in range(1, arguments.seats + 1)]
    port = used_port(seats)
    if port:
        sys.exit(f'port {port}: in use: expected free ports; --master-port and --web-port select others')
    signal.signal(signal.SIGINT, signal.default_int_handler)
    try:
        return run(seats)
    except KeyboardInterrupt:
        return 0
    finally:
        signal.signal(signal.SIGINT, signal.SIG_IGN)
        for seat in seats:
            seat.stop()
        end = time.monotonic() + STOP_TIMEOUT
        for seat in filter(lambda each: each.process, seats):
            try:
                seat.process.wait(max(0.0, end - time.monotonic()))
            except subprocess.TimeoutExpired:
                seat.process.kill()


if __name__ == '__main__':
    sys.exit(main())
