"""Pose estimation: an extended Kalman filter for odometry and gyro."""
