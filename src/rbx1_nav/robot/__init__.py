"""What is true of any robot: kinematics, odometry, its description, and what its sensors report."""
