"""The exercise in a browser without ROS: a stand-in for rospy, and runs as frames for the page."""
