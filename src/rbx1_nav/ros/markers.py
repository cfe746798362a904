"""Markers in the shape of a robot, for RViz."""
import rospy
from geometry_msgs.msg import Point, Pose, Quaternion, Vector3
from std_msgs.msg import ColorRGBA, Header
from tf.transformations import (concatenate_matrices, euler_matrix, quaternion_from_matrix, quaternion_matrix,
                                translation_from_matrix, translation_matrix)
from visualization_msgs.msg import Marker, MarkerArray

SHAPES = {'box': Marker.CUBE, 'cylinder': Marker.CYLINDER, 'sphere': Marker.SPHERE, 'mesh': Marker.MESH_RESOURCE}
LIFETIME = 10       # s: a robot that is not updated any more disappears


def matrix(position, rotation):
    """The 4x4 matrix of a position (with x, y, z in m) and a Quaternion."""
    return concatenate_matrices(translation_matrix((position.x, position.y, position.z)),
                                quaternion_matrix((rotation.x, rotation.y, rotation.z, rotation.w)))


def robot(odometry, visuals, links):
    """A MarkerArray of Visuals at the pose of an Odometry. links: the Transform of each link in the robot's frame."""
    pose = odometry.pose.pose
    base = matrix(pose.position, pose.orientation)
    # stamp 0: the frame's latest transform
    header = Header(frame_id=odometry.header.frame_id)
    array = MarkerArray()
    for number, visual in enumerate(visuals):
        if visual.link in links:
            link = links[visual.link]
            array.markers.append(marker(header, number, visual, concatenate_matrices(
                base, matrix(link.translation, link.rotation), translation_matrix(visual.xyz),
                euler_matrix(*visual.rpy))))
    return array


def marker(header, number, visual, place):
    """A Marker of a Visual at a place (4x4 matrix). number: its id."""
    return Marker(header=header, ns='true_robot', id=number, type=SHAPES[visual.shape],
                  pose=Pose(Point(*translation_from_matrix(place)), Quaternion(*quaternion_from_matrix(place))),
                  scale=Vector3(*visual.size), color=ColorRGBA(*visual.color), lifetime=rospy.Duration(LIFETIME),
                  mesh_resource=visual.mesh, mesh_use_embedded_materials=bool(visual.mesh))
