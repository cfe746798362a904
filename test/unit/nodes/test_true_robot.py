"""true_robot.py shows each part of the robot where the true pose and the transform of its link put it."""
from math import pi

import pytest
import rospy
import tf2_ros
from geometry_msgs.msg import Quaternion, Transform, Vector3
from nav_msgs.msg import Odometry
from visualization_msgs.msg import Marker

from rbx1_nav.base.urdf import Visual
from rbx1_nav.node import life
from loaded_nodes import load, without_master

QUARTER = Quaternion(0, 0, 0.5 ** 0.5, 0.5 ** 0.5)     # 90 degrees to the left
PLACE = dict(xyz=(0.0, 0.0, 0.0), rpy=(0.0, 0.0, 0.0), mesh='', color=None)
VISUALS = [
    Visual(**{**PLACE, 'link': 'arm', 'shape': 'box', 'size': (0.1, 0.2, 0.3), 'xyz': (0.0, 0.0, 0.5),
              'rpy': (0.0, 0.0, pi / 2), 'color': (1.0, 0.0, 0.0, 1.0)}),
    Visual(**{**PLACE, 'link': 'hand', 'shape': 'sphere', 'size': (0.1, 0.1, 0.1)}),
    Visual(**{**PLACE, 'link': 'arm', 'shape': 'mesh', 'size': (1.0, 1.0, 1.0), 'mesh': 'package://a/b.dae'})]
LINKS = {'arm': Transform(Vector3(0.2, 0.1, 0.0), Quaternion(0, 0, 0, 1))}


@pytest.fixture(name='node')
def fixture_node(monkeypatch):
    node = load('true_robot')
    node.topics, node.log = without_master(monkeypatch)

    class Buffer:
        def lookup_transform(self, base, link, _):
            assert base == 'base_footprint'
            if link not in LINKS:
                raise tf2_ros.LookupException()
            return type('Stamped', (), {'transform': LINKS[link]})
    monkeypatch.setattr(tf2_ros, 'Buffer', Buffer)
    monkeypatch.setattr(tf2_ros, 'TransformListener', lambda buffer: (buffer, 'listens'))
    return node


def truth():
    odometry = Odometry(child_frame_id='base_footprint')
    odometry.header.frame_id = 'odom'
    odometry.pose.pose.position.x, odometry.pose.pose.position.y = 1.0, 2.0
    odometry.pose.pose.orientation = QUARTER
    return odometry


def test_the_markers_of_a_robot_that_faces_left(node):
    robot = node.TrueRobot(VISUALS)
    assert robot.listener == (robot.buffer, 'listens')
    robot.on_truth(truth())
    markers = node.topics['true_robot'].sent[0].markers
    # the transform of the hand is not known yet
    assert [(each.id, each.type, each.header.frame_id) for each in markers] == [
        (0, Marker.CUBE, 'odom'), (2, Marker.MESH_RESOURCE, 'odom')]
    place, turn = markers[0].pose.position, markers[0].pose.orientation
    assert (place.x, place.y, place.z) == pytest.approx((0.9, 2.2, 0.5))
    assert (abs(turn.z), abs(turn.w)) == pytest.approx((1, 0), abs=1e-9)
    assert (markers[0].color.r, markers[0].color.a) == (1, 1) and not markers[0].mesh_use_embedded_materials
    assert (markers[1].mesh_resource, markers[1].mesh_use_embedded_materials, markers[1].color.a) == (
        'package://a/b.dae', True, 0)
    assert markers[0].lifetime > rospy.Duration(1)


def test_nothing_is_computed_without_a_viewer_or_during_shutdown(node, monkeypatch):
    robot = node.TrueRobot(VISUALS)
    node.topics['true_robot'].connections = 0
    robot.on_truth(truth())
    node.topics['true_robot'].connections = 1
    monkeypatch.setattr(life.end_requested, 'is_set', lambda: True)
    robot.on_truth(truth())
    assert node.topics['true_robot'].sent == []


@pytest.mark.parametrize('text, status', [('<robot name="a"><link name="b"/></robot>', 0), ('<robot', 1)])
def test_the_node_removes_the_robot_at_its_end(node, monkeypatch, text, status):
    monkeypatch.setattr(rospy, 'get_param', lambda *_: text)
    monkeypatch.setattr(life.end_requested, 'wait', lambda: node.topics['true_robot'].sent.clear())
    assert node.main() == status
    if status:
        assert node.log[-1][0] == 'fatal' and '/true_robot/robot_description: ' in node.log[-1][1]
    else:
        (marker,), = node.topics['true_robot'].sent
        assert marker.action == Marker.DELETEALL
