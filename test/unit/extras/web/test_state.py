"""What a frame contains: the poses, the table of the run before, speeds, and only what is new."""
import json
from math import inf, nan

import pytest

from rbx1_nav.extras.web.state import PoseAndSpeed, PageState


def motion(time, x=0.0, y=0.0, yaw=0.0, linear=0.0, angular=0.0):
    return PoseAndSpeed(time, (x, y, yaw), linear, angular)


class Browser:
    """Reads all frames of a PageState."""

    def __init__(self, state):
        self.state = state
        self.number, self.epoch = 0, -1

    def frame(self):
        self.number, self.epoch, message = self.state.frame(self.number, self.epoch, 0.0)
        return json.loads(message)


@pytest.fixture(name='state')
def make_state():
    return PageState()


def drive(state, start=100.0, seconds=1.0, speed=0.2):
    """Drive ahead; the stamps and the monotonic clock begin at `start`."""
    for tick in range(round(50 * seconds) + 1):
        time = start + tick / 50
        state.command(speed, 0.0, '/out_and_back', time)
        for source in 'odometry', 'truth':
            state.move(source, motion(time, speed * tick / 50, linear=speed), time)


def test_a_frame(state):
    drive(state)
    frame = Browser(state).frame()
    assert frame['poses'] == {'odometry': [0.2, 0, 0], 'truth': [0.2, 0, 0]}
    assert frame['time'] == 1.0 and frame['run'] == '/out_and_back'
    assert len(frame['paths']['truth']) == 11       # a point for each 2 cm of 20 cm, and the first one
    assert frame['speeds']['reported'][0] == [0, 0.2, 0] and frame['speeds']['true']
    # the first command is before the first odometry, without which it has no time
    assert frame['speeds']['commanded'][0] == [0.02, 0.2, 0]


def test_a_browser_that_slept_gets_all_of_it(state):
    awake, asleep = Browser(state), Browser(state)
    asleep.frame()
    paths = []
    for second in range(3):
        drive(state, 100.0 + second)
        paths += awake.frame()['paths']['truth']
    assert asleep.frame()['paths']['truth'] == paths


def test_a_reset_begins_another_run_and_keeps_the_table(state):
    drive(state)
    browser = Browser(state)
    epoch = browser.frame()['epoch']
    # the odometry after the reset may arrive before the message about it
    state.move('odometry', motion(101.02), 101.02)
    state.move('truth', motion(101.02), 101.02)
    state.reset(101.03)
    state.move('odometry', motion(101.04), 101.04)
    frame = browser.frame()
    assert frame['epoch'] == epoch + 1 and frame['time'] == pytest.approx(0.02)
    assert frame['status']['before'] == {'odometry': [0.2, 0, 0], 'truth': [0.2, 0, 0]}
    assert frame['run'] == ''
    assert frame['paths']['odometry'] == [[0, 0, 0]]


def test_late_messages_of_before_a_reset_are_ignored(state):
    drive(state)
    state.reset(101.0)
    state.move('odometry', motion(101.0, 0.2), 101.01)
    assert Browser(state).frame()['poses'] == {}
    state.move('odometry', motion(101.02), 101.02)
    state.move('odometry', motion(101.04, 0.1), 101.04)     # fast simulated time
    assert Browser(state).frame()['paths']['odometry'] == [[0, 0, 0], [0.1, 0, 0]]


@pytest.mark.parametrize('first', [motion(5.0), motion(101.1, x=-3.0)], ids=['time goes back', 'the pose jumps'])
def test_another_base_begins_another_run(state, first):
    drive(state)
    epoch = state.epoch
    state.move('odometry', first, 101.1)
    assert state.epoch == epoch + 1 and Browser(state).frame()['status']['before']['odometry'] == [0.2, 0, 0]


def test_a_run_of_the_page_has_its_name(state):
    state.set_status(started='timed', outcome='')
    drive(state)
    assert Browser(state).frame()['run'] == 'timed'
    state.set_status(outcome='finished')
    drive(state, 102.0)
    assert Browser(state).frame()['run'] == '/out_and_back'


@pytest.mark.parametrize('wrong', [motion(1.0, x=nan), motion(nan), motion(1.0, linear=inf), motion(1.0, yaw=-inf)])
def test_what_is_not_finite_is_ignored(state, wrong):
    state.move('odometry', wrong, 0.0)
    state.command(nan, 0.0, '/node', 0.0)
    assert Browser(state).frame()['poses'] == {}


def test_simulated_time_is_measured(state):
    for tick in range(300):
        state.move('odometry', motion(tick * 0.2), tick * 0.02)
    assert state.factor == pytest.approx(10)
