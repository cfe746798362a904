"""Out and back with a differential drive. Only the subpackage `ros` may import rospy."""
