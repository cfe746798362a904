"""Browsers that are slow, malicious or killed, and pages from other sites."""
import multiprocessing
import os
import re
import signal
import socket
import struct
import time

import support
from rbx1_nav.extras.web.access import TOKEN_VARIABLE, make_token

from web_client import WebClient, request

FAULT = ('requests and WebSockets from a foreign page; another user without the token; 100 connections; slow readers; '
         'ten clients without the token that send as fast as they can, and connect again; random bytes; the browser or '
         'the node is killed while keys drive it')
PROMISE = ('foreign requests are rejected; the robot does not move without the token; others receive their '
           'frames; the memory of the node does not grow, and it logs no errors; the robot stops within 0.5 s if the '
           'browser is killed, and within the timeout of the base (1 s) if the node is killed')
FULL, SHORT = 32, 8
ROOT, ALONE = False, True

SPEED = 0.2             # m/s
TIMEOUT, PERIOD = 1.0, 0.02     # s, timeout of the base and period of its odometry
GONE = 0.5              # s
GAP = 0.3               # s, by which the longest time without a frame may grow beside floods
FLOOD_TIME = 5.0        # s
MEMORY_LIMIT = 20000    # KB
ATTEMPTS = [dict(type='run', method='timed'), dict(type='hand', on=True), dict(type='drive', forward=1.0),
            dict(type='reset')]


class View:
    """The node under test."""

    def __init__(self, row):
        os.environ[TOKEN_VARIABLE] = self.token = make_token()
        self.process = row.node('web_view.py', '_port:=0')
        self.port = int(self.process.wait_for_line(r'Open http://localhost:(\d+)/').group(1))
        self.odom = support.OdomWatch()
        # until the first message on /ground_truth, the robot counts as real
        with_token = WebClient(self.port, self.token)
        support.wait_for(lambda: with_token.wait_for('frame').get('status', {}).get('simulated'), 'the base')
        with_token.close()

    def drive(self):
        """Drive the robot with the keys of a browser; return the browser once the robot moves."""
        client = WebClient(self.port, self.token)
        client.send(type='hand', on=True)
        end = time.monotonic() + support.LIMIT
        while self.odom.last.twist.twist.linear.x != SPEED:
            client.send(type='drive', forward=1.0)
            time.sleep(0.1)
            assert time.monotonic() < end, 'the robot does not move'
        return client

    def stop_and_reset(self, row):
        """Wait until the robot is at rest, and put it back at its start."""
        self.odom.wait_for_twist(0.0)
        row.reset()
        support.wait_for(lambda: self.odom.position() == (0, 0), 'the reset')

    def usage(self):
        """Return (memory in KB, threads, open files) of the node."""
        folder = f'/proc/{self.process.process.pid}'
        with open(f'{folder}/status', encoding='ascii') as file:
            values = dict(line.split(':', 1) for line in file)
        return int(values['VmRSS'].split()[0]), int(values['Threads']), len(os.listdir(f'{folder}/fd'))

    def check(self):
        """Check that a browser with the token receives frames."""
        client = WebClient(self.port, self.token)
        assert client.wait_for('welcome')['trusted']
        client.wait_for('frame')
        client.close()


def foreign_page(row, view):
    """A page from another site sends requests to the view."""
    origin = row.random.choice(['http://evil.example', 'null', f'http://localhost:{view.port + 1}',
                                'https://localhost'])
    host = row.random.choice(['evil.example', f'evil.example:{view.port}', '10.0.0.1', 'localhost.evil.example'])
    for path in '/', '/main.js', '/socket':
        for method in 'GET', 'POST', 'OPTIONS':
            assert request(view.port, path, host, method) == 404, (path, method, host)
    for headers in dict(Origin=origin), dict(Host=host), dict(Host=host, Origin=f'http://{host}'):
        try:
            WebClient(view.port, view.token, **headers)
        except ConnectionError as error:
            assert str(error) == ('404' if 'Host' in headers else '403'), error
        else:
            raise AssertionError(f'accepted: {headers}')
    assert view.odom.position() == (0, 0)


def no_token(row, view):
    """Another user of this machine connects without the token."""
    token = row.random.choice(['', 'wrong', view.token[:-1], view.token + 'A', view.token.swapcase()])
    client = WebClient(view.port, token)
    assert not client.wait_for('welcome')['trusted']
    for message in row.random.choices(ATTEMPTS, k=20):
        client.send(**message)
        assert 'cannot drive' in client.wait_for('refused')['reason']
    client.close()
    assert view.odom.position() == (0, 0)


def many_connections(row, view):
    """100 connections are open, half of which send nothing."""
    silent = [socket.create_connection(('127.0.0.1', view.port)) for _ in range(50)]
    clients = [WebClient(view.port, '') for _ in range(50)]
    started = time.monotonic()
    view.check()
    row.figure('first frame beside 100 connections, s', time.monotonic() - started)
    for each in (*silent, *clients):
        each.close()


def slow_readers(row, view):
    """Some browsers do not read while the robot drives."""
    asleep = [WebClient(view.port, '', small=True) for _ in range(30)]
    before = view.usage()[0]
    driver = row.node('timed_out_and_back.py', '_goal_distance:=0.4')
    awake = WebClient(view.port, '')
    awake.wait_for('frame')
    frames, end = 0, time.monotonic() + support.LIMIT
    while driver.process.poll() is None and time.monotonic() < end:
        awake.wait_for('frame')
        frames += 1
    assert driver.wait() == 0, driver.output
    row.figure('frames beside 30 slow readers', frames)
    growth = view.usage()[0] - before
    row.figure('growth of the memory, KB', growth)
    # 20 frames per second during two legs of 2 s and two turns of 3.1 s; half of them on a busy machine
    assert frames > 100 and growth < MEMORY_LIMIT, (frames, growth)
    # a script that is starved of CPU time loses a few commands; a subscriber that does not read loses most of them
    lost = re.search(r'(\d+) of (\d+) commands to /web_view', driver.output)
    assert not lost or int(lost.group(1)) < 0.05 * int(lost.group(2)), driver.output
    for each in (*asleep, awake):
        each.close()


def flood(port, data):
    """Send data to a view until this process is killed."""
    os.nice(19)     # like another machine, it takes no CPU time from the view
    while True:
        try:
            client = WebClient(port, '')
            while True:
                client.socket.sendall(100 * data)
        except OSError:
            pass


def floods(row, view):
    """Ten clients without the token send as fast as they can, and connect again when they are disconnected."""
    data = [struct.pack('!BB', 0x80 | opcode, 0x80 | len(body)) + bytes(4) + body for opcode, body in (
        (9, b''), (1, b'{"type":"drive"}'), (1, b'{"type":"stop","number":1.5}'))]

    processes = [multiprocessing.Process(target=flood, args=(view.port, row.random.choice(data)), daemon=True)
                 for _ in range(10)]
    owner = view.drive()
    control = longest_gap(view, owner)
    for each in processes:
        each.start()
    try:
        gap = longest_gap(view, owner)
    finally:
        for each in processes:
            each.kill()
            each.join()
    owner.close()
    row.figure('longest time without a frame, s', control)
    row.figure('longest time without a frame beside ten floods, s', gap)
    assert gap < control + GAP, f'{gap:.2f} s'


def longest_gap(view, owner):
    """Drive on for FLOOD_TIME; return the longest time without a frame, s."""
    gaps, last = [], time.monotonic()
    end = last + FLOOD_TIME
    while last < end:
        owner.send(type='drive', forward=1.0)
        owner.wait_for('frame')
        gaps.append(time.monotonic() - last)
        last += gaps[-1]
    return max(gaps)


def random_bytes(row, view):
    """A client sends random bytes instead of requests and frames."""
    for _ in range(20):
        data = row.random.getrandbits(8 * 400).to_bytes(400, 'big')
        with socket.create_connection(('127.0.0.1', view.port), 10) as connection:
            connection.sendall(row.random.choice([data, b'GET / HTTP/1.1\r\n' + data, b'\x16\x03\x01' + data]))
        client = WebClient(view.port, view.token)
        try:
            if row.random.random() < 0.5:
                client.send_frame(row.random.choice([data, b'{"type":"drive","forward":1e999}', b'{}', 500 * b'[']),
                                  row.random.randrange(16))
            else:
                client.socket.sendall(data)
        except OSError:
            pass
        client.close()
    assert view.odom.position() == (0, 0)


def browser_gone(row, view):
    """The driving browser is closed, or its machine fails and it sends nothing more."""
    client = view.drive()
    time.sleep(row.random.uniform(0, 0.1))
    client.send(type='drive', forward=1.0)
    closed = row.random.random() < 0.5
    if closed:
        client.close()
    before = view.odom.position()[0]
    view.odom.wait_for_twist(0.0)
    travel = view.odom.position()[0] - before
    row.figure(f"travel after a browser that {'was closed' if closed else 'fell silent'}, m", travel)
    # the last odometry may be one period old
    assert travel <= SPEED * (GONE + 2 * PERIOD), f'{travel:.3f} m'
    client.close()


def view_killed(row, view):
    """The node is killed with SIGKILL while keys drive the robot."""
    client = view.drive()
    client.send(type='drive', forward=1.0)
    view.process.kill()
    before = view.odom.position()[0]
    view.odom.wait_for_twist(0.0)
    travel = view.odom.position()[0] - before
    row.figure('travel after the view was killed, m', travel)
    assert travel <= SPEED * (TIMEOUT + 2 * PERIOD), f'{travel:.3f} m'
    client.close()


KINDS = [foreign_page, no_token, many_connections, slow_readers, floods, random_bytes, browser_gone, view_killed]


def run(row):
    """See FAULT."""
    row.roscore()
    row.base()
    support.init_node('faults')
    view = None
    for number in range(row.times):
        kind = KINDS[number % len(KINDS)]
        with row.fault(f'{kind.__name__} ({number})'):
            if view is None or view.process.process.poll() is not None:
                view = View(row)
            view.stop_and_reset(row)
            view.check()
            threads, files = view.usage()[1:]
            kind(row, view)
            if kind is view_killed:
                continue
            view.check()
            # the node needs a moment to close a connection
            support.wait_for(lambda: view.usage()[1] <= threads + 2 and view.usage()[2] <= files + 2,
                             f'the view to release threads and files: {threads}, {files} before, {view.usage()} now')
            errors = [line for line in view.process.lines if 'Traceback' in line or 'ERROR' in line]
            assert not errors, view.process.output
    if view and view.process.process.poll() is None:
        view.process.signal(signal.SIGTERM)
        assert view.process.wait() == 0, view.process.output
