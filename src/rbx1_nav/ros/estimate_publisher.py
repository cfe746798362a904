"""Publishes the combined odometry as a pose and a transform."""
import rospy
from geometry_msgs.msg import PoseWithCovarianceStamped
from tf2_msgs.msg import TFMessage

from rbx1_nav.model.kinematics import relative_frame
from rbx1_nav.ros import messages
from rbx1_nav.schedule import Schedule


class EstimatePublisher:
    """Publishes Estimates at a given rate."""

    def __init__(self, rate, output_frame, publish_tf):
        """rate: Hz; output_frame: of the pose; publish_tf: whether to publish the transform too."""
        self.output_frame = output_frame
        self.publish_tf = publish_tf
        self.schedule = Schedule(rate)
        self.pose_pub = rospy.Publisher('odom_combined', PoseWithCovarianceStamped, queue_size=10)
        self.tf_pub = rospy.Publisher('/tf', TFMessage, queue_size=100, tcp_nodelay=True)

    def update(self, estimate, odom_frame, base_frame):
        """Publish an Estimate if it is due. odom_frame, base_frame: the frames of the odometry that it is based on."""
        if not self.schedule.due(estimate.stamp):
            return
        stamp = rospy.Time(0, estimate.stamp)
        self.pose_pub.publish(messages.planar_pose(stamp, self.output_frame, estimate.pose, estimate.covariance))
        if self.publish_tf:
            # a frame has one parent: if that of the base frame is odom, ours is the parent of odom
            child, pose = ((base_frame, estimate.pose) if self.output_frame == odom_frame
                           else (odom_frame, relative_frame(estimate.pose, estimate.odom.pose)))
            self.tf_pub.publish([messages.transform(stamp, self.output_frame, child, pose)])
