"""A Stop is answered when the odometry reports that the robot is stationary, or with what is missing."""
import pytest

from rbx1_nav.extras.web.controls import FRESH, LIMIT
from test_connections import TOKEN, View


@pytest.fixture(name='view')
def make_view():
    return View()


def answer(view, socket):
    """Return the answers that a browser has received, after another frame."""
    view.connections.send_frames()
    return [message for message in socket.messages if message['type'] == 'stopped']


def test_the_answer_waits_until_the_robot_is_stationary(view):
    socket = view.connect('')
    view.move(0.1)
    view.system.stopped = ['/out_and_back']
    view.send(socket, type='stop', number=7)
    assert socket.messages[-1] == {'type': 'stopping', 'number': 7}
    assert not answer(view, socket)     # the last odometry is older than Stop
    view.now += 0.1
    view.move(0.2)
    assert not answer(view, socket)
    for name in 'pending', 'busy':
        view.system.pending, view.runs.busy = name == 'pending', name == 'busy'
        view.move(0.2, 0.0)
        assert not answer(view, socket), name
    view.runs.busy = False
    assert answer(view, socket) == [{'type': 'stopped', 'number': 7, 'stationary': True, 'silent': [],
                                     'text': 'Stopped /out_and_back. The robot was stationary 0.1 s after Stop.'}]
    assert len(answer(view, socket)) == 1


def test_after_the_answer_no_other_node_drives(view):
    socket = view.connect(TOKEN)
    view.send(socket, type='stop')
    view.state.command(0.2, 0.0, '/out_and_back', view.now)     # its last one, which was on its way
    view.now += 0.1
    view.move(0.2, 0.0)
    assert answer(view, socket)
    view.send(socket, type='hand', on=True)
    assert 'refused' not in socket.kinds and view.hand.drivers


@pytest.mark.parametrize('silent, speed, text', [
    ([], None, 'Zero commands were sent. There is no odometry later than 0.0 s after Stop: the robot may still be '
               'moving.'),
    ([], 0.2, 'Zero commands were sent. The robot was still moving 3.1 s after Stop.'),
    (['/b'], 0.0, 'Stopped. No answer from /b: the robot may move again. The robot was stationary 3.1 s after Stop.')])
def test_what_is_missing_is_in_the_answer(view, silent, speed, text):
    socket = view.connect('')
    view.system.silent = silent
    view.send(socket, type='stop')
    view.now += LIMIT + 0.1
    if speed is not None:
        view.move(0.1, speed)
    found = answer(view, socket)
    assert [each['text'] for each in found] == [text] and found[0]['stationary'] == (speed == 0)
    assert found[0]['silent'] == silent


def test_odometry_of_a_base_that_hangs_is_not_the_present_speed(view):
    socket = view.connect('')
    view.send(socket, type='stop')
    view.now += 0.1
    view.move(0.0, 0.2)
    view.now += FRESH + 0.1
    assert not answer(view, socket)
    view.now += LIMIT
    text = answer(view, socket)[0]['text']
    assert text.endswith('There is no odometry later than 0.1 s after Stop: the robot may still be moving.')


def test_stops_are_one_while_one_is_pending(view):
    sockets = [view.connect('') for _ in range(50)]
    view.send(sockets[0], type='stop')
    view.system.searching = True
    for socket in sockets[1:]:
        view.send(socket, type='stop')
    assert view.system.calls == ['shut down']
    view.system.searching = False
    view.now += 0.5
    view.move(0.1, 0.0)
    view.connections.send_frames()      # a node may have begun to drive since the first search
    assert view.system.calls == 2 * ['shut down']
    assert all(len(answer(view, socket)) == 1 for socket in sockets)


def test_stop_needs_the_token_if_the_parameter_says_so(view):
    view.controls.stop_needs_token = True
    watcher, user = view.connect(''), view.connect(TOKEN)
    view.send(watcher, type='stop')
    assert watcher.messages[-1]['reason'].startswith('Stop needs the token here') and not view.runs.calls
    view.send(user, type='stop')
    assert view.runs.calls == ['stop']
