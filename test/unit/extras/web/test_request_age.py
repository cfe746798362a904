"""Frames arrive although nothing changes, and a request shows by the clock of the last frame how old it is."""
import pytest

from rbx1_nav.extras.web.connections import FRAME_TIMEOUT
from rbx1_nav.extras.web.controls import MAX_AGE, OLD
from test_connections import MOVES, TOKEN, View


@pytest.fixture(name='view')
def make_view():
    return View()


def test_a_frame_is_sent_although_nothing_has_changed(view):
    socket = view.connect('')
    view.connections.send_frames()
    view.now += FRAME_TIMEOUT + 0.01
    view.connections.send_frames()
    assert socket.kinds == ['welcome', 'frame', 'frame'] and socket.messages[-1]['clock'] == round(view.now, 3)


@pytest.mark.parametrize('age, started', [(0.0, True), (MAX_AGE - 0.01, True), (MAX_AGE + 0.01, False), (-1.0, False)])
def test_an_old_request_moves_nothing(view, age, started):
    for message in MOVES:
        socket = view.connect(TOKEN)
        view.send(socket, clock=view.now - age, **message)
        assert (socket.messages[-1].get('reason', '') == OLD) is not started, message
        assert started or not (view.runs.calls or view.hand.drivers or view.system.calls)


def test_an_old_release_of_a_key_and_an_old_stop_are_obeyed(view):
    socket = view.connect(TOKEN)
    view.send(socket, type='hand', on=True)
    view.send(socket, type='drive', clock=0)
    assert view.hand.calls[-1] == (0.0, 0.0)
    view.send(socket, type='drive', forward=1, clock=view.now - MAX_AGE - 0.01)
    assert view.hand.calls[-1] == (0.0, 0.0) and socket.messages[-1]['reason'] == OLD
    view.send(socket, type='hand', clock=0)
    view.send(socket, type='stop', clock=0)
    assert view.hand.calls[-2:] == ['leave', 'stop']
