"""A script that finds no base names the other namespaces and topics where one may be, and how to reach them."""
from types import SimpleNamespace

import pytest
import rospy

from rbx1_nav.driving import base_connection
from rbx1_nav.driving.base_connection import wait_for_listeners

TWIST, ODOMETRY = 'geometry_msgs/Twist', 'nav_msgs/Odometry'
KOBUKI = '/mobile_base/commands/velocity'
MISSING = 'a base that subscribes to /cmd_vel'


@pytest.fixture(name='missing')
def fixture_missing(monkeypatch):
    """A function that waits for a base without success, and returns what is missing. It takes the types of topics, and
    the names of their subscribers and publishers."""
    monkeypatch.setattr(base_connection.rosgraph, 'get_master_uri', lambda: 'http://master')

    def run(kinds, subscribers, publishers=(), topic='/cmd_vel', mappings=(), namespace='/'):
        answers = {'getSystemState': ([*dict(publishers).items()], [*subscribers.items()], []),
                   'getTopicTypes': [*kinds.items()]}
        calls = []
        monkeypatch.setattr(base_connection, 'call', lambda _, method: calls.append(method) or answers[method])
        monkeypatch.setattr(rospy, 'get_name', lambda: '/script')
        monkeypatch.setattr(rospy, 'get_namespace', lambda: namespace)
        monkeypatch.setattr(rospy.names, 'get_resolved_mappings', lambda: dict(mappings))
        publisher = SimpleNamespace(resolved_name=topic, impl=SimpleNamespace(connections=[]))
        with pytest.raises(rospy.ROSException) as error:
            wait_for_listeners(publisher, 0, True, print)
        assert calls == ['getSystemState', 'getTopicTypes']
        return str(error.value).split('waiting for ')[1]
    return run


def test_the_topics_of_other_bases(missing):
    assert missing({}, {}) == MISSING
    assert missing({KOBUKI: TWIST, '/cmd_vel': TWIST}, {KOBUKI: ['/mobile_base_nodelet_manager']}) == (
        f'{MISSING}. Other Twist topics have subscribers: {KOBUKI}. To use one, add cmd_vel:={KOBUKI}')
    assert missing({'/b': TWIST, '/a': TWIST}, {'/b': ['/gazebo'], '/a': ['/mux']}) == (
        f'{MISSING}. Other Twist topics have subscribers: /a, /b. To use one, add cmd_vel:=/a')


def test_topics_on_which_nothing_can_be_driven(missing):
    kinds = {'/rosout': 'rosgraph_msgs/Log', '/odom': ODOMETRY, '/own': TWIST, '/page': TWIST, '/alone': TWIST}
    subscribers = {'/rosout': ['/rosout'], '/odom': ['/ekf'], '/own': ['/script'], '/page': ['/web_view'],
                   '/unknown': ['/recorder']}
    assert missing(kinds, subscribers, {'/page': ['/web_view'], '/alone': ['/other']}) == MISSING


def test_a_base_in_another_namespace_is_named_once(missing):
    kinds = {'/robot1/cmd_vel': TWIST, '/robot1/odom': ODOMETRY, '/velocity': TWIST}
    text = missing(kinds, {'/robot1/cmd_vel': ['/robot1/base'], '/velocity': ['/kobuki']},
                   {'/robot1/odom': ['/robot1/base']})
    assert text == (f'{MISSING}. Bases exist in other namespaces: /robot1. To drive one, set ROS_NAMESPACE=/robot1. '
                    'Other Twist topics have subscribers: /velocity. To use one, add cmd_vel:=/velocity')


def test_the_name_to_remap_is_the_one_in_the_script(missing):
    kinds, subscribers = {'/velocity': TWIST}, {'/velocity': ['/kobuki']}
    assert missing(kinds, subscribers, topic='/velocty', mappings={'/cmd_vel': '/velocty'}).endswith(
        'add cmd_vel:=/velocity')
    assert missing(kinds, subscribers, topic='/robot1/cmd_vel', namespace='/robot1/').endswith(
        'add /robot1/cmd_vel:=/velocity')
