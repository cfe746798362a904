"""The arithmetic of robot_pose_ekf for wheel odometry and an IMU, in the plane, without ROS.

Written from the behavior of these sources: robot_pose_ekf's odom_estimation.cpp (the models, and what is measured),
odom_estimation_node.cpp (initial pose, covariances) and nonlinearanalyticconditionalgaussianodo.cpp (the motion), and
the kalmanfilter.cpp and extendedkalmanfilter.cpp of BFL 0.8 (the update). Units: meters, radians, seconds.
"""
import math

import numpy

from figures import relative

SYSTEM_NOISE = 1000.0 ** 2      # added to each variance in each update: only the measurements count
PRIOR_VARIANCE = 0.001 ** 2     # of the initial pose
IMU = numpy.array([[0.0, 0.0, 1.0]])    # an IMU measures the yaw, odometry measures the complete state
ODOM = numpy.eye(3)


class RobotPoseEkf:
    """The estimated pose: x, y, yaw, and its covariance. One update per pair of messages.

    The node updates at its `freq`, up to the older of the two latest messages. This class uses every pair, so the
    estimate is never outdated.
    """

    def __init__(self):
        self.state = None           # x, y, yaw
        self.covariance = None
        self.time = None            # s, of the last update
        self.before = None          # (odometry's pose, IMU's yaw) at the last update

    def update(self, time, odom, odom_variances, imu_yaw, imu_variance):
        """Use odometry and an IMU's orientation with the same stamp.

        odom: its pose (x, y, yaw); odom_variances: of x, y, yaw; imu_yaw: yaw of the orientation.
        """
        measured = odom, imu_yaw
        if self.state is None:      # the odometry pose is the initial pose
            self.state, self.covariance = numpy.array(odom, float), PRIOR_VARIANCE * numpy.eye(3)
            self.time = time
            return
        elapsed = time - self.time
        if elapsed <= 0:
            return
        old = self.state.copy()
        # the motion is 0, so the state does not change, and its derivative is the identity matrix
        self.covariance = self.covariance + SYSTEM_NOISE * numpy.eye(3)
        if self.before:             # there is no previous pose to compare with in the first update
            odom_before, yaw_before = self.before
            self._correct(ODOM, compose(old, relative(odom, odom_before)), numpy.diag(odom_variances) * elapsed ** 2)
            self._correct(IMU, [near(old[2] + imu_yaw - yaw_before, old[2])], [[imu_variance * elapsed ** 2]])
        self.before = measured
        self.time = time

    def _correct(self, model, measured, noise):
        gain_times_s = self.covariance @ model.T
        gain = gain_times_s @ numpy.linalg.inv(model @ gain_times_s + noise)
        self.state = gain @ (measured - model @ self.state) + self.state
        self.covariance = self.covariance - gain @ model @ self.covariance


def compose(start, motion):
    """The pose after a motion in the frame of the start pose; its yaw is within pi of the start yaw."""
    c, s = math.cos(start[2]), math.sin(start[2])
    return numpy.array([start[0] + motion[0] * c - motion[1] * s, start[1] + motion[0] * s + motion[1] * c,
                        near(start[2] + motion[2], start[2])])


def near(angle, reference):
    """The equivalent angle within pi of a reference."""
    return reference + math.remainder(angle - reference, 2 * math.pi)
