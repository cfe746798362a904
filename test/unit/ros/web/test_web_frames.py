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
