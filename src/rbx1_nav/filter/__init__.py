"""The filter that combines odometry and gyro into one pose, and its node."""
