"""Who may do what, how many browsers there may be, and how fast they get frames."""
from asyncio import Future
import json
from types import SimpleNamespace

import pytest

from rbx1_nav.extras.web.access import Access
from rbx1_nav.extras.web.connections import MAX_OF_ADDRESS, MAX_SILENT, MAX_WATCHERS, Connections
from rbx1_nav.extras.web.controls import Controls
from rbx1_nav.extras.web.state import PoseAndSpeed, PageState

TOKEN, CODE = 'the token', 'a code'
MOVES = dict(type='run', method='timed'), dict(type='hand', on=True), dict(type='reset')


class Hand:
    """Takes the place of HandDrive."""

    def __init__(self):
        self.drivers, self.calls = set(), []

    def begin(self, owner):
        self.drivers.add(owner)

    def leave(self, owner):
        self.drivers.discard(owner)
        self.calls.append('leave')

    def drive(self, owner, linear, angular):
        self.calls.append((linear, angular))
        return owner in self.drivers

    def stop(self):
        self.drivers.clear()
        self.calls.append('stop')

    def wait_until_quiet(self, _):
        self.calls.append('wait')


class Runs:
    """Takes the place of Runs."""
    busy = False

    def __init__(self):
        self.calls = []

    def start(self, method, before):
        self.calls.append(method)
        before(lambda: False)
        return not self.busy

    def stop(self):
        self.calls.append('stop')


class System:
    """Takes the place of System."""
    simulated = True

    def __init__(self):
        self.calls = []

    def reset(self):
        self.calls.append('reset')

    pending = searching = False
    stopped, silent = (), ()

    def shut_down_drivers(self):
        self.calls.append('shut down')

    def take_shut_down(self):
        return list(self.stopped), list(self.silent)


class Socket:
    """Takes the place of a WebSocket."""

    def __init__(self, slow=False, address='10.0.0.1'):
        self.slow = slow
        self.request = SimpleNamespace(remote_ip=address)
        self.messages, self.closed = [], None

    def write_message(self, message, binary=False):
        self.messages.append(json.loads(message))
        future = Future(loop=LOOP)
        if not self.slow:
            future.set_result(None)
        return future

    def close(self, code=None, reason=None):
        self.closed = code, reason

    @property
    def kinds(self):
        return [message['type'] for message in self.messages]


class Loop:
    """What a Future needs of an event loop."""

    def get_debug(self):
        return False

    def call_soon(self, *_, **__):
        pass


LOOP = Loop()


class View:
    """The parts, connected."""

    def __init__(self):
        self.now = 100.0
        self.state, self.system, self.hand, self.runs = PageState(), System(), Hand(), Runs()
        self.log = []
        self.controls = Controls(self.state, self.system, self.hand, self.runs, (0.2, 1.0), lambda call: call(),
                                 lambda: self.now, self.log.append)
        self.connections = Connections(self.state, self.controls, Access(TOKEN, CODE), lambda: self.now)

    def connect(self, token=None, slow=False, address='10.0.0.1', code=''):
        socket = Socket(slow, address)
        self.connections.opened(socket)
        if token is not None:
            self.send(socket, type='hello', token=token, code=code)
        return socket

    def send(self, socket, **fields):
        self.connections.received(socket, json.dumps({'clock': self.now, **fields}))

    def move(self, x, speed=0.2):
        self.state.move('odometry', PoseAndSpeed(self.now + x, (x, 0.0, 0.0), speed, 0.0), self.now)


@pytest.fixture(name='view')
def make_view():
    return View()


@pytest.mark.parametrize('message', [*MOVES, dict(type='drive', forward=1)])
@pytest.mark.parametrize('token', ['', 'wrong'])
def test_without_the_token_nothing_moves(view, message, token):
    socket = view.connect(token)
    view.send(socket, **message)
    assert socket.kinds == ['welcome', 'refused'] and 'cannot drive' in socket.messages[1]['reason']
    assert not (view.hand.calls or view.runs.calls or view.system.calls or view.hand.drivers)
    assert socket.messages[0]['trusted'] is False and socket.messages[0]['token'] == ''
    assert socket.messages[0]['rejected'] == ('token' if token else '')


def test_a_code_is_exchanged_once_for_the_token(view):
    first, second = view.connect('', code=CODE), view.connect('', code=CODE)
    assert first.messages[0]['trusted'] and first.messages[0]['token'] == TOKEN
    assert not second.messages[0]['trusted'] and second.messages[0]['rejected'] == 'code'
    # with the token, another code is not used up
    view.send(first, type='invite')
    code = first.messages[-1]['code']
    assert view.connect(TOKEN, code=code).messages[0]['rejected'] == '' != code
    assert view.connect('', code=code).messages[0]['token'] == TOKEN


def test_only_the_owner_invites(view):
    socket = view.connect('')
    view.send(socket, type='invite')
    assert socket.kinds == ['welcome', 'refused']


def test_stop_needs_no_token(view):
    socket = view.connect('')
    view.send(socket, type='stop')
    assert view.runs.calls == ['stop'] and view.hand.calls == ['stop'] and view.system.calls == ['shut down']


@pytest.mark.parametrize('message', [dict(type='run', method='timed', reset=True), dict(type='reset')])
def test_driving_by_hand_has_ended_before_the_robot_is_reset(view, message):
    socket = view.connect(TOKEN)
    view.send(socket, type='hand', on=True)
    view.send(socket, **message)
    assert view.hand.calls == ['stop', 'wait'] and view.system.calls == ['reset'] and not view.hand.drivers


@pytest.mark.parametrize('message', MOVES)
def test_nothing_moves_while_another_node_drives(view, message):
    socket = view.connect(TOKEN)
    view.state.command(0.2, 0.0, '/out_and_back', view.now)
    view.now += 1.5     # its pause between two motions
    view.send(socket, **message)
    assert socket.messages[-1]['reason'] == '/out_and_back is driving the robot: stop it first'
    assert not (view.runs.calls or view.hand.drivers or view.system.calls)
    view.now += 1.0
    view.send(socket, **message)    # it has ended
    assert socket.kinds == ['welcome', 'refused']


def test_a_real_robot_has_to_be_confirmed(view):
    view.system.simulated = False
    socket = view.connect(TOKEN)
    for message in MOVES:
        view.send(socket, **message)
    assert socket.kinds == ['welcome', *3 * ['refused']]
    assert not (view.runs.calls or view.hand.drivers or view.system.calls)
    for message in MOVES[:2]:
        view.send(socket, confirmed=True, **message)
    assert view.runs.calls == ['timed'] and len(view.hand.drivers) == 1 and socket.kinds.count('refused') == 3


def test_keys(view):
    socket = view.connect(TOKEN)
    view.send(socket, type='drive', forward=1)
    assert socket.kinds[-1] == 'refused'
    view.send(socket, type='hand', on=True)
    view.send(socket, type='drive', forward=-1, left=0.5)
    assert view.hand.calls[-1] == (-0.2, 0.5) and socket.kinds.count('refused') == 1


def test_a_browser_that_goes_away_no_longer_drives(view):
    socket = view.connect(TOKEN)
    view.send(socket, type='hand', on=True)
    view.connections.closed(socket)
    assert view.hand.calls == ['leave'] and not view.connections.browsers
    view.connections.closed(socket)
    view.send(socket, type='stop')
    assert view.hand.calls == ['leave']


@pytest.mark.parametrize('text', ['', 'x', b'\0', '{"type": "drive", "forward": 2}', '{"type": "hello", "token": ""}'])
def test_a_malformed_message_ends_the_connection(view, text):
    socket = view.connect(TOKEN)
    view.send(socket, type='hand', on=True)
    view.connections.received(socket, text)
    assert socket.closed[0] == 1008 and not view.connections.browsers and view.hand.calls[-1] == 'leave'


def test_hello_comes_first(view):
    early, silent = view.connect(), view.connect()
    view.send(early, type='stop')
    assert early.closed[0] == 1008 and not view.runs.calls
    view.connections.send_frames()
    assert not (silent.messages or silent.closed)


def test_the_number_of_browsers_without_the_token_is_limited(view):
    watchers = [view.connect('wrong', address=f'10.0.0.{number // MAX_OF_ADDRESS}') for number in range(MAX_WATCHERS)]
    refused = view.connect('', address='10.0.0.9')
    assert refused.closed == (1013, 'too many pages without the token') and not refused.messages
    assert not any(each.closed for each in watchers)
    assert view.connect(TOKEN).kinds == ['welcome']
    view.connections.closed(watchers[0])
    assert view.connect('', address='10.0.0.9').kinds == ['welcome']


def test_one_address_does_not_take_all_places(view):
    owner = view.connect(TOKEN)
    for _ in range(MAX_OF_ADDRESS):
        assert not view.connect('').closed
    assert view.connect('').closed[0] == 1013
    assert view.connect('', address='10.0.0.2').kinds == view.connect(TOKEN).kinds == owner.kinds == ['welcome']


def test_connections_without_hello_make_room_for_further_ones(view):
    silent = [view.connect() for _ in range(MAX_SILENT + 1)]
    assert [bool(each.closed) for each in silent] == [True] + MAX_SILENT * [False]
    assert len(view.connections.browsers) == MAX_SILENT


def test_a_slow_browser_loses_frames_and_no_path(view):
    slow, fast = view.connect('', slow=True), view.connect('')
    for step in range(20):
        view.move(0.1 * step)
        view.connections.send_frames()
    assert slow.kinds == ['welcome'] and len(fast.messages) == 21
    view.connections.browsers[slow].sending.set_result(None)
    view.connections.send_frames()
    assert len(slow.messages) == 2 and len(slow.messages[1]['paths']['odometry']) == 20
