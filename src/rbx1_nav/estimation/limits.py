"""Limits of the motion and of the gyro errors of the robots that the filter supports."""
from math import radians
from typing import NamedTuple


class Limits(NamedTuple):
    """The limits of a robot; the defaults suit robots up to 5 m/s, with a margin for the noise of the odometry."""
    max_speed: float = 6.0                  # m/s: odometry that moves faster has jumped
    max_turn_rate: float = 6.0              # rad/s: odometry that turns faster has jumped
    max_angular_acceleration: float = 10.0  # rad/s^2: how fast the turn rate may change while gyro readings are lost
    gyro_bias: float = radians(10)          # rad/s: the largest bias of a gyro, in either direction
    gyro_scale_error: float = 0.007         # 1 sigma of the gyro's scale error if the floor is unknown; 3 sigma: 2 %
