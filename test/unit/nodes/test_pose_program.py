"""pose.py prints the latest pose of each topic that is published, and names the bases of other namespaces."""
from math import pi

from geometry_msgs.msg import Quaternion
from nav_msgs.msg import Odometry
import pytest
import rospy

from rbx1_nav.node import life
from loaded_nodes import load, without_master


@pytest.fixture(name='pose')
def fixture_pose(monkeypatch, capsys):
    """Runs pose.py; pose.published: topics; pose.sent: messages by topic. Returns (status, what it prints, its log)."""
    node = load('pose')
    clock = [0.0]

    def sleep(duration):
        clock[0] += duration
        for topic, message in pose.sent.items():
            if topic in topics:
                topics[topic].callback(message)

    def pose():
        status = node.main()
        return status, capsys.readouterr().out.splitlines(), log
    topics, log = without_master(monkeypatch)
    pose.published, pose.sent = ['/odom', '/odom_ekf', '/tf'], {}
    monkeypatch.setattr(rospy, 'get_published_topics', lambda: [(name, '') for name in pose.published])
    monkeypatch.setattr(node.time, 'monotonic', lambda: clock[0])
    monkeypatch.setattr(life, 'sleep', sleep)
    return pose


def odometry(x, y, quaternion):
    message = Odometry()
    message.pose.pose.position.x, message.pose.pose.position.y = x, y
    message.pose.pose.orientation = quaternion
    return message


def test_the_table(pose):
    pose.sent = {'odom': odometry(3.0, -4.0, Quaternion(0, 0, -0.5 ** 0.5, 0.5 ** 0.5)),
                 'odom_ekf': odometry(-0.0004, -1e-9, Quaternion(0, 0, 0, 1))}
    status, (head, *rows), _ = pose()
    assert status == 0 and ' '.join(head.split()) == 'x (m) y (m) heading (degrees) from the start (m)'
    assert [row.split() for row in rows] == [
        ['truth', '/ground_truth', 'not', 'published'], ['odometry', '/odom', '3.000', '-4.000', f'{-90:.1f}', '5.000'],
        ['estimate', '/odom_ekf', '0.000', '0.000', '0.0', '0.000']]
    assert len({row.rindex('0') for row in rows[1:]} | {len(head) - 1}) == 1


def test_a_topic_without_a_message(pose):
    pose.sent = {'odom': odometry(0.0, 0.0, Quaternion(0, 0, 1, pi / 1e9))}
    status, rows, _ = pose()
    assert status == 0 and rows[3].split()[2:] == ['no', 'message', 'for', '5', 's'] and ' 180.0 ' in rows[2]


@pytest.mark.parametrize('published, end', [
    (['/tf'], 'a running base'),
    (['/b/odom', '/a/odom'], 'Bases exist in other namespaces: /a, /b. To see one, set ROS_NAMESPACE=/a')])
def test_without_a_base(pose, published, end):
    pose.published = published
    status, rows, log = pose()
    assert status == 1 and rows == [] and log[-1][0] == 'err' and log[-1][1].endswith(end)
    assert log[-1][1].startswith('No message on /ground_truth, /odom, /odom_ekf for 5 s: ')
