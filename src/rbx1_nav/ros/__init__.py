"""Code shared by the nodes, and everything that depends on ROS. The only subpackage that may import rospy."""
