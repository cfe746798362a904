"""A publisher that registers together with a subscriber is not lost."""
import pytest
from rospy.impl.registration import RegManager

from rbx1_nav.ros.network.rospy_topics import repair_connections

ORIGINAL = RegManager.publisher_update


@pytest.fixture(name='manager')
def fixture_manager(monkeypatch):
    """Return a RegManager whose thread is not running."""
    monkeypatch.setattr(RegManager, 'publisher_update', ORIGINAL)
    repair_connections()
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
