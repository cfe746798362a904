"""What a robot is: kinematics, wheels, gyro, joints, and the surface below them."""
