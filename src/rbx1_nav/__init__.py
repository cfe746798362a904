"""Out and back with a differential drive: a core that knows nothing of ROS, and what its nodes share."""
