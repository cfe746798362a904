#!/usr/bin/env python3
"""Shows the robot at its true pose in RViz: subscribes to /ground_truth and publishes markers in the robot's shape.

usage: true_robot.py [_parameter:=value ...] [topic:=new_topic ...]      started by fake_turtlebot.launch on a surface

RViz's own RobotModel display shows the robot at its odometry pose.
"""
import rbx1_nav.ros.node.early_interrupt     # first, so that Ctrl-C during the other imports exits quietly

import time

import rospy
import tf2_ros
from nav_msgs.msg import Odometry
from visualization_msgs.msg import Marker, MarkerArray

from rbx1_nav.parameters import elsewhere
from rbx1_nav.robot.urdf import read_visuals
from rbx1_nav.ros.node import life
from rbx1_nav.ros.tools import markers
from rbx1_nav.schedule import Schedule

PARAMETERS = [elsewhere('robot_description', "the robot's URDF, as text")]


class TrueRobot:
    """Publishes the robot's markers while there are subscribers."""

    def __init__(self, visuals):
        """visuals: the robot's Visuals, see robot/urdf.py."""
        self.visuals = visuals
        self.schedule = Schedule(20)    # Hz of wall time, for a human viewer
        self.buffer = tf2_ros.Buffer()
        self.listener = tf2_ros.TransformListener(self.buffer)
        self.publisher = rospy.Publisher('true_robot', MarkerArray, queue_size=1)
        rospy.Subscriber('ground_truth', Odometry, self.on_truth, queue_size=1, tcp_nodelay=True)

    def on_truth(self, truth):
        """Publish the robot at its true pose."""
        if life.end_requested.is_set():     # topics are closed during shutdown
            return
        if self.publisher.get_num_connections() and self.schedule.due(time.monotonic_ns()):
            links = {}
            for link in {visual.link for visual in self.visuals}:
                try:
                    links[link] = self.buffer.lookup_transform(truth.child_frame_id, link, rospy.Time(0)).transform
                except tf2_ros.TransformException:
                    pass    # robot_state_publisher has not published it yet
            self.publisher.publish(markers.robot_markers(truth, self.visuals, links))

    def remove(self):
        """Remove the robot from the screen."""
        self.publisher.publish([Marker(action=Marker.DELETEALL)])


def main():
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
