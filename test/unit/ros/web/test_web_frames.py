"""A frame is made once for all browsers, and a slow browser gets complete paths."""
import pytest

from test_connections import View


@pytest.fixture(name='view')
def make_view():
    return View()


def test_a_slow_browser_loses_frames_and_no_path(view):
    slow, fast = view.connect('', slow=True), view.connect('')
    for step in range(20):
        view.move(0.1 * step)
        view.connections.send_frames()
    assert slow.kinds == ['welcome'] and len(fast.messages) == 21
    view.connections.browsers[slow].sending.set_result(None)
    view.connections.send_frames()
    assert len(slow.messages) == 2 and len(slow.messages[1]['paths']['odometry']) == 20


def test_a_frame_is_made_once_for_all(view):
    for _ in range(30):
        view.connect('')
    view.move(0.1)
    view.connections.send_frames()
    made = []
    original = view.state.frame
    view.state.frame = lambda *key: made.append(key) or original(*key)
    view.move(0.2)
    view.connections.send_frames()
    assert len(made) == 1
