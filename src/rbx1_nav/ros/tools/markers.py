"""Creates markers in the shape of a robot, for RViz."""
from __future__ import annotations

from typing import Mapping, Sequence

from geometry_msgs.msg import Point, Pose, Quaternion, Transform, Vector3
from nav_msgs.msg import Odometry
import rospy
from std_msgs.msg import ColorRGBA, Header
from tf.transformations import (concatenate_matrices, euler_matrix, quaternion_from_matrix, quaternion_matrix,
                                translation_from_matrix, translation_matrix)
from visualization_msgs.msg import Marker, MarkerArray

from rbx1_nav.arrays import Array
from rbx1_nav.robot.urdf import Visual

SHAPES = {'box': Marker.CUBE, 'cylinder': Marker.CYLINDER, 'sphere': Marker.SPHERE, 'mesh': Marker.MESH_RESOURCE}
GREY = (0.5, 0.5, 0.5, 1.0)
LIFETIME = 10       # s: a robot that is no longer updated disappears


def matrix(position: Point | Vector3, rotation: Quaternion) -> Array:
    """Return the 4x4 matrix of a position (m) and a rotation."""
    return concatenate_matrices(translation_matrix((position.x, position.y, position.z)),
                                quaternion_matrix((rotation.x, rotation.y, rotation.z, rotation.w)))


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
