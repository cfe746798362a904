"""Code for any robot, real or simulated: kinematics, odometry, the description of a robot, and sensor readings."""
