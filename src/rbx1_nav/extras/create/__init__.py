"""Driver of the iRobot Create: converts commands to bytes, and bytes to odometry."""
