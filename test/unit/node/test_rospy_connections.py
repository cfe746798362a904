"""Connections of a node: none is missed or made twice, the order is kept, and a publisher is complete before them."""
from threading import Event, Thread
import time

import pytest
from rospy.impl.registration import RegManager

from rbx1_nav.node import rospy_connections


@pytest.fixture(name='manager')
def fixture_manager(monkeypatch):
    """Return a RegManager whose thread is not running."""
    monkeypatch.setattr(RegManager, 'publisher_update', RegManager.publisher_update)
    rospy_connections.repair_connections()
    return RegManager(None)


def test_publishers_of_several_lists_are_named_once_and_topics_are_kept_apart(manager):
    for topic, publishers in ('/odom', ['a', 'b']), ('/tf', ['d']), ('/odom', ['b', 'c']), ('/odom', []):
        for _ in range(2):      # rospy passes on each notice of the master once per publisher
            manager.publisher_update(topic, publishers)
    assert manager.updates[-1] == ('/odom', ['a', 'b', 'c']) and ('/tf', ['d']) in manager.updates


def test_only_one_thread_at_a_time_connects_to_a_publisher(manager, monkeypatch):
    events, filter_connects = [], Event()

    def connect(_, __, uri):
        events.append((uri, 'begin'))
        filter_connects.set() if uri == 'filter' else filter_connects.wait()
        events.append((uri, 'end'))
    monkeypatch.setattr(rospy_connections, '_connect', connect)
    threads = [Thread(target=manager._connect_topic_thread, args=('/odom', uri)) for uri in ('base', 'base', 'filter')]
    [thread.start() for thread in threads], [thread.join() for thread in threads]
    assert [what for uri, what in events if uri == 'base'] == 2 * ['begin', 'end'] and len(events) == 6


def test_connections_are_added_in_the_order_in_which_they_arrive(monkeypatch):
    added = []
    monkeypatch.setattr(rospy_connections, 'HEADER_TIME', 60)
    monkeypatch.setattr(rospy_connections, '_read_header', lambda _, late, __: time.sleep(late) or added.append(late))
    for late in 0.05, 0:
        rospy_connections._read_header_in_thread(None, late, None)
    assert added == [0.05, 0]


def test_a_publisher_is_complete_before_somebody_connects(monkeypatch):
    events, connected = [], Event()

    def create(_):
        Thread(target=rospy_connections._read_header_in_thread, args=(None, None, None)).start()
        connected.wait(0.1)
        events.append('complete')
    monkeypatch.setattr(rospy_connections, '_create', create)
    monkeypatch.setattr(rospy_connections, '_read_header', lambda *_: events.append('connected') or connected.set())
    rospy_connections._create_before_connections(None)
    connected.wait()
    assert events == ['complete', 'connected']
