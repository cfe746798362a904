"""Motion commands: timed motions, odometry-based legs, and the gate that checks every command."""
