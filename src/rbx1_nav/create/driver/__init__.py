"""Drives an iRobot Create: from commands to bytes, from bytes to odometry."""
