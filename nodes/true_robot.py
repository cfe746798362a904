#!/usr/bin/env python3
"""Shows the robot where it really is, for RViz: /ground_truth in, markers in the shape of the robot out.

usage: true_robot.py [_parameter:=value ...] [topic:=new_topic ...]      started by fake_turtlebot.launch on a surface

RViz's own RobotModel shows the robot where its odometry reports it.
"""
import rbx1_nav.ros.node.early_interrupt     # Ctrl-C ends the node quietly even while the rest is loaded

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
    """Publishes the robot's markers while somebody subscribes."""

    def __init__(self, visuals):
        """visuals: of the robot, see robot/urdf.py."""
        self.visuals = visuals
        self.schedule = Schedule(20)    # Hz of wall time, as the eye sees it
        self.buffer = tf2_ros.Buffer()
        self.listener = tf2_ros.TransformListener(self.buffer)
        self.publisher = rospy.Publisher('true_robot', MarkerArray, queue_size=1)
        rospy.Subscriber('ground_truth', Odometry, self.on_truth, queue_size=1, tcp_nodelay=True)

    def on_truth(self, truth):
        """Publish the robot at its true pose."""
        if life.end_requested.is_set():     # topics are closed at the end
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
    """Run until the node is to end. Returns the exit status."""
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
