"""Many simulated runs without ROS, in several processes or on a cluster, and their plots."""
