#!/usr/bin/python3
"""seats.py gives each learner a master, a base and a page, and stops all of them when it exits."""
from contextlib import closing, suppress
import os
import signal
import sys
from urllib.request import urlopen
from xmlrpc.client import ServerProxy

import roslib.packages

from ports import free_port
import support

sys.path.append(os.path.join(os.path.dirname(__file__), '..', 'faults'))
from web_client import WebClient


def answers(port):
    """Return the nodes of the master at a port, or None if there is none."""
    try:
        _, _, (_, subscribers, _) = ServerProxy(f'http://localhost:{port}').getSystemState('/test')
    except OSError:
        return None
    return {node for _, nodes in subscribers for node in nodes}


def title(port, token):
    """Return the title of the page at a port; None if no node that knows the token answers."""
    with suppress(OSError):
        client = WebClient(port, token)
        return client.wait_for('welcome')['trusted'] and client.wait_for('frame')['status']['title']


def token_of(port, process):
    """Return the token of the seat whose page is at a port: exchange the code that its process prints."""
    code = process.wait_for_line(r' 1 .*/#(\S+)').group(1)
    client = WebClient(port, '', code=code)
    with closing(client):
        return client.wait_for('welcome')['token']


class TestSeats(support.Case):
    def start(self, *arguments):
        """Start seats.py; return its Process."""
        node = roslib.packages.find_node('rbx1_nav', 'seats.py')[0]
        return support.Process('/usr/bin/python3', node, *map(str, arguments))

    def check(self, seats, ending, status):
        """Start seats, check them, and end the process with a signal."""
        masters, pages = free_port() - seats, free_port() - seats
        process = self.start(seats, '--master-port', masters, '--web-port', pages, '--surface', 'hard_floor')
        process.wait_for_line(f'Ready: {seats} seats')
        tokens = set()
        for number in range(1, seats + 1):
            match = process.wait_for_line(f' {number}  http://localhost:{masters + number} +'
                                          rf'(http://localhost:{pages + number}/)#(\S+)')
            tokens.add(match.group(2))
            self.assertIn(b'Out and back', urlopen(match.group(1)).read())
            nodes = {'/arbotix', '/web_view', '/robot_pose_ekf'}
            support.wait_for(lambda: nodes <= answers(masters + number), 'all nodes')
        self.assertEqual(len(tokens), seats)
        process.signal(ending)
        self.assertEqual(process.wait(), status, process.output)
        support.wait_for(lambda: not any(answers(masters + number) for number in range(1, seats + 1)), 'the masters')

    def test_ctrl_c_stops_all_seats(self):
        self.check(2, signal.SIGINT, 0)

    def test_a_neighbor_cannot_stop_a_seat(self):
        page = free_port()
        process = self.start(1, '--master-port', free_port() - 1, '--web-port', page - 1)
        token = token_of(page, process)
        for given, answer in ('', 'refused'), (token, 'stopping'):
            client = WebClient(page, given)
            client.send(type='stop', number=1)
            self.assertEqual(client.wait_for(answer)['type'], answer)
            client.close()

    def test_seats_end_with_a_process_that_is_killed(self):
        self.check(1, signal.SIGKILL, -signal.SIGKILL)

    def test_a_seat_that_exits_is_started_again(self):
        masters, page = free_port() - 1, free_port()
        process = self.start(1, '--master-port', masters, '--web-port', page - 1)
        token = token_of(page, process)
        self.assertEqual(title(page, token), 'Seat 1')
        process.wait_for_line('Ready: 1 seats')
        master = ServerProxy(f'http://localhost:{masters + 1}')
        base = master.lookupNode('/test', '/arbotix')[2]
        with suppress(OSError):     # it exits without an answer
            ServerProxy(base).shutdown('/test', 'by a learner')
        process.wait_for_line('REQUIRED process .arbotix.*; starting it again')
        support.wait_for(lambda: title(page, token) == 'Seat 1', 'the page of the seat')


if __name__ == '__main__':
    support.main(TestSeats)
