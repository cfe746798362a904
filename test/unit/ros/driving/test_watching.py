"""Listeners detects problems from the state of the connections, without a master."""
from types import SimpleNamespace

import pytest
import rospy

from rbx1_nav.ros.driving import watching
from rbx1_nav.ros.driving.watching import Listeners, Peer
from rbx1_nav.ros.network.tcp import CLOSED_WINDOW, Connection

OPEN = Connection(established=True, unacknowledged=0, acknowledged=520, window=60000)
SILENT = OPEN._replace(unacknowledged=52)
FULL = SILENT._replace(window=CLOSED_WINDOW - 1)
CLOSED = OPEN._replace(established=False)


@pytest.fixture(name='watch')
def watch_one(monkeypatch):
    """Return watch(essential), which returns the Listeners of one connection, with its state as attribute `state`."""
    monkeypatch.setenv('ROS_MASTER_URI', 'http://127.0.0.1:1/')    # nothing answers there
    monkeypatch.setattr(rospy.rostime, 'is_wallclock', lambda: True)

    def watch(essential=True):
        connection = SimpleNamespace(endpoint_id='/node', stat_num_msg=0, socket=None)
        publisher = SimpleNamespace(resolved_name='/cmd_vel', impl=SimpleNamespace(connections=[connection], seq=0))
        # without an address, the node is not called
        watched = Listeners(publisher, [Peer('/node', None, essential, False, None)])
        watched.state = OPEN
        monkeypatch.setattr(watching, 'read_connection', lambda _: watched.state)
        return watched
    return watch


def problem(watched):
    return watched.listeners[0].problem


@pytest.mark.parametrize('state, essential, expected', [
    (OPEN, True, None),
    (SILENT, True, '/node does not acknowledge any data'),
    (SILENT, False, '/node does not acknowledge any data'),
    (FULL, True, '/node, which publishes the odometry, does not read its commands'),
    (FULL, False, None)])
def test_silence_for_more_than_a_second(watch, state, essential, expected):
    watched = watch(essential)
    watched.look(10.0)
    watched.state = state
    watched.look(10.05)
    watched.look(11.04)
    assert problem(watched) is None
    watched.look(11.1)
    assert problem(watched) == expected


def test_a_node_that_closes_after_the_last_command_is_not_taken_for_one_that_has_all(watch):
    watched = watch()
    watched.state = CLOSED
    assert not watched.listeners[0].has_all(0, 0.0)
    with pytest.raises(rospy.ROSException, match='/node disconnected'):
        watched.check_delivery()
