#!/usr/bin/env python3
"""Makes the combined odometry visible: odom_combined, a pose, becomes /odom_ekf, an odometry that RViz draws as arrows.

Both odometries begin where the robot does, so both are told in the frame of the wheels' own: to see them side by side.
"""
import rospy
from geometry_msgs.msg import PoseWithCovarianceStamped
from nav_msgs.msg import Odometry

from rbx1_nav import messages, node


class OdomEkf:
    """Republishes each pose."""

    def __init__(self):
        node.init_node('odom_ekf')
        self.frames = None      # (frame_id, child_frame_id) of the wheels' odometry
        self.last = None        # PoseWithCovarianceStamped
        self.publisher = rospy.Publisher('/odom_ekf', Odometry, queue_size=10)
        rospy.Subscriber('odom', Odometry, self.on_odom)
        rospy.Subscriber('odom_combined', PoseWithCovarianceStamped, self.on_pose)

    def on_odom(self, odom):
        """The wheels' odometry tells the names of the frames."""
        self.frames = odom.header.frame_id.lstrip('/'), odom.child_frame_id.lstrip('/')

    def on_pose(self, pose):
        """A combined pose, and the speed since the one before."""
        if self.frames:
            self.publisher.publish(messages.odometry_of_pose(pose, self.last, *self.frames))
        self.last = pose


def main():
    """Run until the node is told to end. Returns the exit status."""
    OdomEkf()
    node.end_requested.wait()
    return 0


if __name__ == '__main__':
    node.run(main)
