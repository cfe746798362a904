"""What the filter accepts: odometry and gyro readings, and the checks that reject invalid ones."""
from collections import namedtuple

from rbx1_nav.robot.readings import MIN_VARIANCE

MAX_NUMBER = 1e6        # m or rad/s: above this, sums lose what is small
MAX_VARIANCE = 1 / MIN_VARIANCE

Odom = namedtuple('Odom', 'stamp pose linear_variance angular_variance')
Odom.__doc__ = 'Wheel odometry: stamp in ns, Pose in its frame, variances of its speeds (m^2/s^2, rad^2/s^2).'

Imu = namedtuple('Imu', 'stamp rate variance is_mean', defaults=[False])
Imu.__doc__ = """A reading: stamp in ns, angular velocity (rad/s), its variance (rad^2/s^2), and whether it is the mean
since the previous reading, however long ago."""


class RejectedMessage(ValueError):
    """A message that must not reach the filter. The text names the field, the value and what is expected."""


def check(field, value, good, expected):
    """Raises RejectedMessage if a value is not good."""
    if not good:
        raise RejectedMessage(f'{field}: {value}: expected {expected}')


def check_number(field, value):
    """Raises RejectedMessage if a value is not finite, or above MAX_NUMBER."""
    check(field, value, abs(value) <= MAX_NUMBER, f'a number of at most {MAX_NUMBER:g}')


def check_variance(field, value):
    """Raises RejectedMessage if a variance is not between MIN_VARIANCE and MAX_VARIANCE."""
    check(field, value, MIN_VARIANCE <= value <= MAX_VARIANCE,
          f'a variance above 0, from {MIN_VARIANCE:g} to {MAX_VARIANCE:g}')


def check_odom(odom, pose_variances):
    """Raises RejectedMessage if an Odom cannot be used.

    pose_variances: of x, y (m^2) and yaw (rad^2). A variance of 0 of a speed means that the sender does not give it.
    """
    for field, value in zip(('position.x', 'position.y', 'orientation'), odom.pose):
        check_number(f'pose.pose.{field}', value)
    for index, variance in zip((0, 7, 35), pose_variances):
        check_variance('pose.covariance[%d]' % index, variance)
    for index, variance in ((0, odom.linear_variance), (35, odom.angular_variance)):
        if variance != 0:
            check_variance('twist.covariance[%d]' % index, variance)


def check_imu(imu):
    """Raises RejectedMessage if an Imu cannot be used."""
    check_number('angular_velocity.z', imu.rate)
    check_variance('angular_velocity_covariance[8]', imu.variance)
