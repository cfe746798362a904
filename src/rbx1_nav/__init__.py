"""The out-and-back exercise for a differential-drive robot.

Only the subpackage `ros` may import rospy.
"""
