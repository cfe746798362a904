#!/usr/bin/env python3
"""Starts a ROS master, a simulated TurtleBot and its page in the browser for each of several learners on this machine.

Prints the addresses of the teacher's page and of each learner's, which are valid for the first browser that opens them,
and the ROS_MASTER_URI for terminals of the learner. Ctrl-C stops all seats.
"""
from __future__ import annotations

import rbx1_nav.node.early_interrupt     # first, so that Ctrl-C during the other imports exits quietly

import argparse
import signal
import socket
import subprocess
import sys
import time
from typing import Sequence

from rbx1_nav.base.surfaces import known_surfaces, load_surface
from rbx1_nav.extras.web.access import Access, make_token, page_address
from rbx1_nav.extras.web.choices import CHOICES, read_choices
from rbx1_nav.extras.web.seat import Seat
from rbx1_nav.extras.web.seat_list import SeatList
from rbx1_nav.extras.web.server import PageServer
from rbx1_nav.node import resources
from rbx1_nav.node.config import ConfigError
from rbx1_nav.simulation.slip import RANDOM, read_seed

STOP_TIMEOUT = 20.0     # s for all seats to stop
MAX_SEATS = 100


def read_arguments() -> argparse.Namespace:
    """Return the checked command-line arguments."""
    parser = argparse.ArgumentParser(description=__doc__.split('\n')[0])
    parser.add_argument('seats', type=int, help=f'number of seats, 1 to {MAX_SEATS}')
    parser.add_argument('--surface', default='ideal', metavar='NAME',
                        help=f"one of {', '.join(known_surfaces(resources.surfaces()))}; default: ideal. On all "
                             'others, and if learners can choose the surface, the filter is also started')
    parser.add_argument('--seed', default='random', help='seed of the errors; default: random')
    parser.add_argument('--choices', default=','.join(CHOICES), metavar='NAMES',
                        help=f"what learners can choose: some of {','.join(CHOICES)}, or none; default: all")
    parser.add_argument('--rviz', action='store_true', help='also start what RViz needs to show the robot')
    parser.add_argument('--address', default='localhost',
                        help='where the pages are served; default: localhost, for this machine only')
    parser.add_argument('--master-port', type=int, default=11311, metavar='PORT',
                        help='seat N has its master at this port plus N; default: 11311')
    parser.add_argument('--web-port', type=int, default=8080, metavar='PORT',
                        help="port of the teacher's page; seat N has its page at this port plus N; default: 8080")
    arguments = parser.parse_args()
    if not 1 <= arguments.seats <= MAX_SEATS:
        parser.error(f'seats: {arguments.seats}: expected an integer from 1 to {MAX_SEATS}')
    for name in 'master_port', 'web_port':
        if not 1024 <= getattr(arguments, name) <= 65535 - MAX_SEATS:
            parser.error(f"--{name.replace('_', '-')}: {getattr(arguments, name)}: expected 1024 to "
                         f'{65535 - MAX_SEATS}')
    if abs(arguments.master_port - arguments.web_port) <= arguments.seats:
        parser.error(f'--web-port: {arguments.web_port}: expected a port that is {arguments.seats + 1} or more away '
                     f'from --master-port, {arguments.master_port}')
    try:
        read_choices(arguments.choices)
        load_surface(arguments.surface, resources.surfaces())
        read_seed(arguments.seed if arguments.seed == RANDOM else int(arguments.seed))
    except (ConfigError, ValueError) as error:
        parser.error(f'{error}')
    return arguments


def launch_arguments(arguments: argparse.Namespace) -> list[str]:
    """Return the arguments of seat.launch that are the same for all seats."""
    model = resources.path('urdf', 'turtlebot.urdf') if arguments.rviz else 'none'
    return [f'model:={model}', f'surface:={arguments.surface}', f'seed:={arguments.seed}',
            f'choices:={arguments.choices}']


def report(text: str) -> None:
    """Report what has happened to a seat."""
    print(text, file=sys.stderr)


def check_ports(seats: Sequence[Seat], address: str, web_port: int) -> None:
    """Exit with a message if the teacher's page or a seat cannot use its ports."""
    for host, port in [(address, web_port), *(
            each for seat in seats for each in (('', seat.master_port), (address, seat.web_port)))]:
        with socket.socket() as test:
            test.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
            try:
                test.bind((host, port))
            except OSError as error:
                sys.exit(f'address {host or "of this machine"}, port {port}: {error}: expected an address of this '
                         'machine and free ports; see --address, --master-port and --web-port')


def serve_teacher(seats: Sequence[Seat], address: str, port: int) -> None:
    """Serve the teacher's page, and print its address."""
    access = Access(make_token())
    PageServer(resources.path('web'), {'/socket': SeatList(access, seats)}, address, port, 'seats.html',
               [each.web_port for each in seats]).start()
    print(f'Page for the teacher: {page_address(address, port, access.invite())}')


def run(seats: Sequence[Seat]) -> int:
    """Start the seats, and start those again that exit. Returns 1 when none is left."""
    print('seat  ROS_MASTER_URI            page')
    for seat in seats:
        if not seat.start():
            sys.exit(f'seat {seat.number}: not started: {seat.error()}')
        print(f'{seat.number:4}  http://localhost:{seat.master_port:<7} {seat.page}')
    print(f'Ready: {len(seats)} seats. Ctrl-C stops them')
    left = set(seats)
    while left:
        for seat in [each for each in left if not each.is_running]:
            report(f'seat {seat.number}: exited: {seat.error()}; starting it again')
            if seat.start():
                report(f'seat {seat.number}: started again; another browser can use {seat.page}')
            else:
                left.remove(seat)
                report(f'seat {seat.number}: not started: {seat.error()}')
        time.sleep(0.5)
    return 1


def main() -> int:
    """Run until Ctrl-C; return the exit status."""
    arguments = read_arguments()
    shared = launch_arguments(arguments)
    address, web_port = arguments.address, arguments.web_port
    seats = [Seat(number, arguments.master_port + number, address, web_port + number, web_port, shared, report)
             for number in range(1, arguments.seats + 1)]
    check_ports(seats, address, web_port)
    signal.signal(signal.SIGINT, signal.default_int_handler)
    try:
        serve_teacher(seats, address, web_port)
        return run(seats)
    except KeyboardInterrupt:
        return 0
    finally:
        signal.signal(signal.SIGINT, signal.SIG_IGN)
        for seat in seats:
            seat.stop()
        end = time.monotonic() + STOP_TIMEOUT
        for process in filter(None, [seat.process for seat in seats]):
            try:
                process.wait(max(0.0, end - time.monotonic()))
            except subprocess.TimeoutExpired:
                process.kill()


if __name__ == '__main__':
    sys.exit(main())
