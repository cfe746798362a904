"""Where the robot is: an extended Kalman filter of odometry and gyro."""
