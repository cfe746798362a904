"""What the messages of the topics change on the page, and which nodes Stop shuts down."""
import os

from nav_msgs.msg import Odometry
import pytest
import rospy

from rbx1_nav.extras.web import system
from rbx1_nav.extras.web.state import PageState
from waiting import wait_for

SURFACES = os.path.join(os.path.dirname(__file__), '..', '..', '..', '..', 'config', 'surfaces')
PUBLISHERS = [['/cmd_vel', ['/stranger']], ['/other/cmd_vel', ['/driver', '/unnamed']]]


@pytest.fixture(name='view')
def make_view(monkeypatch):
    monkeypatch.setattr(system, 'MIN_PERIOD', 0)
    monkeypatch.setattr(system.resources, 'surfaces', lambda: SURFACES)     # also without a workspace
    return system.System(PageState())


def receive(view, connection):
    """Receive the odometry of a robot at rest."""
    message = Odometry()
    message.pose.pose.orientation.w = 1.0
    message._connection_header = connection
    view.on_odometry(message, 'odometry')


def test_a_new_connection_to_a_base_begins_another_run(view):
    old, new = {'callerid': '/arbotix'}, {'callerid': '/arbotix'}
    receive(view, old)
    receive(view, old)
    assert view.state.epoch == 0
    receive(view, new)
    assert view.state.epoch == 1


def test_two_bases_at_once_do_not_begin_a_run_with_each_message(view):
    first, second = {'callerid': '/arbotix'}, {'callerid': '/turtlebot_node'}
    for connection in first, second, first, second:
        receive(view, connection)
    assert view.state.epoch == 1


def test_stop_shuts_down_the_drivers_of_the_remapped_topic(view, monkeypatch):
    shut_down = []

    def call(uri, method, *arguments):
        if method == 'getSystemState':
            return PUBLISHERS, [], []
        if method == 'lookupNode':
            return f'uri of {arguments[0]}'
        shut_down.append((uri, method))
        return None
    monkeypatch.setattr(rospy.names, '_resolved_mappings', {'/cmd_vel': '/other/cmd_vel'})
    monkeypatch.setattr(rospy, 'get_name', lambda: '/unnamed')
    monkeypatch.setattr(system, 'call', call)
    view.shut_down_drivers()
    wait_for(lambda: not view.pending)
    assert shut_down == [('uri of /driver', 'shutdown')] and view.take_shut_down() == (['/driver'], [])
