"""What the messages of the topics change on the page, and which nodes Stop shuts down."""
import os
import socket
from types import SimpleNamespace

from geometry_msgs.msg import Twist
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


@pytest.fixture(name='calls')
def replace_calls(view, monkeypatch):
    """Let the view, with a connection to /connected, call the master and nodes; returns the calls of nodes."""
    calls = []

    def call(uri, method, *arguments):
        if method == 'getSystemState':
            return PUBLISHERS, [], []
        if method == 'lookupNode':
            return f'uri of {arguments[0]}'
        calls.append((uri, method))
        return None
    monkeypatch.setattr(rospy.names, '_resolved_mappings', {'/cmd_vel': '/other/cmd_vel'})
    monkeypatch.setattr(rospy, 'get_name', lambda: '/unnamed')
    monkeypatch.setattr(system, 'call', call)
    connections = [SimpleNamespace(callerid_pub=f'/{name}', endpoint_id=f'uri of /{name}')
                   for name in ('connected', 'unnamed')]
    view.commands = SimpleNamespace(impl=SimpleNamespace(connections=connections))
    return calls


def test_stop_shuts_down_the_drivers_of_the_remapped_topic(view, calls):
    view.shut_down_drivers()
    wait_for(lambda: not view.pending)
    assert sorted(calls) == [('uri of /connected', 'shutdown'), ('uri of /driver', 'shutdown')]
    assert view.take_shut_down() == (['/connected', '/driver'], [])


def test_stop_shuts_down_the_drivers_that_are_connected_if_the_master_is_silent(view, calls, monkeypatch):
    shut_down = system.call

    def call(uri, method, *arguments):
        if method == 'getSystemState':
            raise socket.timeout
        return shut_down(uri, method, *arguments)
    monkeypatch.setattr(system, 'call', call)
    monkeypatch.setattr(rospy, 'logwarn_throttle', lambda *_: None)
    view.shut_down_drivers()
    wait_for(lambda: not view.pending)
    assert calls == [('uri of /connected', 'shutdown')] and view.take_shut_down() == (['/connected'], ['the master'])


def test_a_node_that_answers_only_the_second_request_may_drive_on(view):
    view.silent.add('/driver')
    view.stopped.add('/driver')
    assert view.take_shut_down() == ([], ['/driver']) and view.take_shut_down() == ([], [])


def test_the_poses_of_a_robot_at_rest_are_read_less_often_until_it_is_commanded_to_move(view):
    view.moved = -system.REST_TIME
    receive(view, {'callerid': '/arbotix'})
    assert not view.moving.is_set()
    command = Twist()
    command._connection_header = {'callerid': '/driver'}
    view.on_command(command)
    assert not view.moving.is_set()
    command.angular.z = -0.1
    view.on_command(command)
    assert view.moving.is_set()
    receive(view, {'callerid': '/arbotix'})     # the robot does not move yet
    assert view.moving.is_set()
