#!/usr/bin/env python3
"""Shows the robot at its true pose in RViz: subscribes to /ground_truth and publishes markers in the robot's shape.

usage: true_robot.py [_parameter:=value ...] [topic:=new_topic ...]      started by fake_turtlebot.launch on a surface

RViz's own RobotModel display shows the robot at its odometry pose.
"""
from __future__ import annotations

import rbx1_nav.node.early_interrupt     # first, so that Ctrl-C during the other imports exits quietly

import time
from typing import Mapping, Sequence

from geometry_msgs.msg import Point, Pose, Quaternion, Transform, Vector3
from nav_msgs.msg import Odometry
import rospy
from std_msgs.msg import ColorRGBA, Header
from tf.transformations import (
    concatenate_matrices, euler_matrix, quaternion_from_matrix, quaternion_matrix, translation_from_matrix,
    translation_matrix)
import tf2_ros
from visualization_msgs.msg import Marker, MarkerArray

from rbx1_nav.base.schedule import Schedule
from rbx1_nav.base.units import Array
from rbx1_nav.base.urdf import Visual, read_visuals
from rbx1_nav.node import life
from rbx1_nav.node.parameters import elsewhere

PARAMETERS = [elsewhere('robot_description', "the robot's URDF, as text")]
SHAPES = {'box': Marker.CUBE, 'cylinder': Marker.CYLINDER, 'sphere': Marker.SPHERE, 'mesh': Marker.MESH_RESOURCE}
GREY = (0.5, 0.5, 0.5, 1.0)
LIFETIME = 10       # s: a robot that is no longer updated disappears


def matrix(position: Point | Vector3, rotation: Quaternion) -> Array:
    """Return the 4x4 matrix of a position (m) and a rotation."""
    found: Array = concatenate_matrices(translation_matrix((position.x, position.y, position.z)),
                                        quaternion_matrix((rotation.x, rotation.y, rotation.z, rotation.w)))
    return found


def robot_markers(odometry: Odometry, visuals: Sequence[Visual],
                  links: Mapping[str | None, Transform]) -> MarkerArray:
    """Return markers of the Visuals at the pose of an Odometry. links: transforms of the links in the robot's frame."""
    pose = odometry.pose.pose
    base = matrix(pose.position, pose.orientation)
    # stamp 0: the frame's latest transform
    header = Header(frame_id=odometry.header.frame_id)
    array = MarkerArray()
    for number, visual in enumerate(visuals):
        if visual.link in links:
            link = links[visual.link]
            array.markers.append(visual_marker(header, number, visual, concatenate_matrices(
                base, matrix(link.translation, link.rotation), translation_matrix(visual.xyz),
                euler_matrix(*visual.rpy))))
    return array


def visual_marker(header: Header, number: int, visual: Visual, transform: Array) -> Marker:
    """Return a Marker of a Visual with a transform (4x4 matrix). number: id of the marker."""
    # RViz shows a mesh in its own colors if the marker has none
    color = visual.color or ((0, 0, 0, 0) if visual.mesh else GREY)
    return Marker(header=header, ns='true_robot', id=number, type=SHAPES[visual.shape],
                  pose=Pose(Point(*translation_from_matrix(transform)), Quaternion(*quaternion_from_matrix(transform))),
                  scale=Vector3(*visual.size), color=ColorRGBA(*color), lifetime=rospy.Duration(LIFETIME),
                  mesh_resource=visual.mesh, mesh_use_embedded_materials=visual.color is None)


class TrueRobot:
    """Publishes the robot's markers while there are subscribers."""

    def __init__(self, visuals: Sequence[Visual]) -> None:
        self.visuals = visuals
        self.schedule = Schedule(20)    # Hz of wall time, for a human viewer
        self.buffer = tf2_ros.Buffer()
        self.listener = tf2_ros.TransformListener(self.buffer)
        self.publisher = rospy.Publisher('true_robot', MarkerArray, queue_size=1)
        rospy.Subscriber('ground_truth', Odometry, self.on_truth, queue_size=1, tcp_nodelay=True)

    def on_truth(self, truth: Odometry) -> None:
        """Publish the robot at its true pose."""
        if life.end_requested.is_set():     # topics are closed during shutdown
            return
        if self.publisher.get_num_connections() and self.schedule.due(time.monotonic_ns()):
            links: dict[str | None, Transform] = {}
            for link in {visual.link for visual in self.visuals}:
                try:
                    links[link] = self.buffer.lookup_transform(truth.child_frame_id, link, rospy.Time(0)).transform
                except tf2_ros.TransformException:
                    pass    # robot_state_publisher has not published it yet
            self.publisher.publish(robot_markers(truth, self.visuals, links))

    def remove(self) -> None:
        """Remove the robot from the screen."""
        self.publisher.publish([Marker(action=Marker.DELETEALL)])


def main() -> int:
    """Run until shutdown is requested; return the exit status."""
    life.init_node('true_robot', __doc__, PARAMETERS)
    try:
        visuals = read_visuals(str(rospy.get_param('~robot_description', '')))
    except ValueError as error:
        rospy.logfatal('%s/robot_description: %s', rospy.get_name(), error)
        return 1
    robot = TrueRobot(visuals)
    life.end_requested.wait()
    robot.remove()
    return 0


if __name__ == '__main__':
    life.run(main)
