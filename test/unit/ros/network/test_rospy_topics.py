"""The connections of a node: none is missed, they keep their order, and a publisher is complete before them."""
from threading import Event, Thread
import time

import pytest
from rospy.impl.registration import RegManager

from rbx1_nav.ros.network import rospy_topics


@pytest.fixture(name='manager')
def fixture_manager(monkeypatch):
    """Return a RegManager whose thread is not running."""
    monkeypatch.setattr(RegManager, 'publisher_update', RegManager.publisher_update)
    rospy_topics.repair_connections()
    return RegManager(None)


def test_an_answer_without_a_publisher_does_not_replace_the_notice_of_it(manager):
    manager.publisher_update('/odom', ['http://base/'])
    manager.publisher_update('/odom', [])
    assert manager.updates[-1] == ('/odom', ['http://base/'])       # rospy uses the last list of a topic


def test_publishers_of_several_lists_are_named_once_and_topics_are_kept_apart(manager):
    for topic, publishers in ('/odom', ['a', 'b']), ('/tf', ['d']), ('/odom', ['b', 'c']):
        for _ in publishers:                # rospy passes on each notice of the master once per publisher
            manager.publisher_update(topic, publishers)
    assert manager.updates[-1] == ('/odom', ['a', 'b', 'c']) and ('/tf', ['d']) in manager.updates


def test_connections_are_added_in_the_order_in_which_they_arrive(monkeypatch):
    added = []
    monkeypatch.setattr(rospy_topics, 'HEADER_TIME', 60)
    monkeypatch.setattr(rospy_topics, '_read_header', lambda _, late, __: time.sleep(late) or added.append(late))
    for late in 0.05, 0:
        rospy_topics._read_header_in_thread(None, late, None)
    assert added == [0.05, 0]


def test_a_publisher_is_complete_before_somebody_connects(monkeypatch):
    events, connected = [], Event()

    def create(_):
        Thread(target=rospy_topics._read_header_in_thread, args=(None, None, None)).start()
        connected.wait(0.1)
        events.append('complete')
    monkeypatch.setattr(rospy_topics, '_create', create)
    monkeypatch.setattr(rospy_topics, '_read_header', lambda *_: events.append('connected') or connected.set())
    rospy_topics._create_before_connections(None)
    connected.wait()
    assert events == ['complete', 'connected']
