"""What the nodes share and what depends on ROS. The only subpackage that may import rospy."""
