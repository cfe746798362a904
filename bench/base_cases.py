"""Robot bases of other projects: the cases of bases.py."""
from typing import NamedTuple, Optional

SMALL, MEDIUM, LARGE = (1e-5, 1e-5), (0.001, 0.03), (0.1, 0.5)      # variances, see Case
LAB, HARD, CARPET = 'create_lab_floor', 'hard_floor', 'low_ply_carpet'

SHORT = dict(lab=LAB, hard=HARD)


class Case(NamedTuple):
    """A base and the messages that it sends. Pairs of variances for odometry: x and y (m^2), and yaw (rad^2), also used
    for the speeds (per s^2); for an IMU: rate (rad^2/s^2), and orientation (rad^2)."""
    name: str
    floor: str
    odom: Optional[tuple] = None        # variances; None: as reported by the simulated base
    odom_at_rest: Optional[tuple] = None    # None: as while moving
    imu: Optional[tuple] = None         # variances; None: as reported by the simulated gyro
    bias: Optional[float] = None        # degrees/s, at the start; None: drawn, see the surface file
    drift: float = 0.0                  # of the bias, degrees/s per minute
    scale: Optional[float] = None       # error of the gyro, fraction of the rate; None: drawn, see the surface file
    ratio: float = 1.0                  # mean ratio of the wheels' turn to the true turn; 1: slip of the floor
    speed: float = 0.2                  # m/s
    odom_rate: int = 50                 # Hz
    imu_rate: int = 50                  # Hz
    unbiased: str = ''                  # the name of the corresponding case with a bias of 0
    rest: float = 3.0                   # s before the first motion; 0: the messages begin while the robot drives
    path: str = 'legs'                  # a key of bases.PATHS, or random
    fault: str = ''                     # one of the faults in README.md


# a comment names the driver or robot that a case is taken from; the other cases vary one property
CASES = {case.name: case for case in (
    Case('lab_small', LAB, SMALL),
    Case('lab_medium', LAB, MEDIUM),            # husky_control, jackal_control: control.yaml of diff_drive_controller
    Case('lab_large', LAB, LARGE),
    Case('hard_small', HARD, SMALL),
    Case('hard_medium', HARD, MEDIUM),
    Case('hard_large', HARD, LARGE),
    Case('carpet_small', CARPET, SMALL),
    Case('carpet_medium', CARPET, MEDIUM),
    Case('carpet_large', CARPET, LARGE),
    Case('carpet_bias_0', CARPET, bias=0.0),
    Case('carpet_bias_1', CARPET, bias=1.0, unbiased='carpet_bias_0'),
    Case('carpet_bias_3', CARPET, bias=3.0, unbiased='carpet_bias_0'),
    Case('carpet_bias_6', CARPET, bias=6.0, unbiased='carpet_bias_0'),
    Case('hard_bias_0', HARD, bias=0.0),
    Case('hard_bias_6', HARD, bias=6.0, unbiased='hard_bias_0'),
    Case('lab_medium_bias_0', LAB, MEDIUM, bias=0.0),
    Case('lab_medium_bias_6', LAB, MEDIUM, bias=6.0, unbiased='lab_medium_bias_0'),
    Case('bias_drift', CARPET, MEDIUM, bias=1.0, drift=0.5),
    Case('gyro_scale', CARPET, bias=1.6, scale=0.02),
    Case('skid_1.5', CARPET, MEDIUM, ratio=1.5),    # jackal_control: wheel_separation_multiplier 1.5, not applied here
    Case('skid_2', CARPET, MEDIUM, ratio=2.0),      # husky_control: 1.875, not applied here
    Case('skid_3', CARPET, MEDIUM, ratio=3.0),
    Case('fast', HARD, MEDIUM, speed=3.0, odom_rate=25),    # husky_control: max_velocity 3.0
    Case('odom_10_imu_30', CARPET, MEDIUM, odom_rate=10, imu_rate=30),      # robot_localization, test1.bag: a Husky
    Case('odom_25_imu_100', CARPET, MEDIUM, odom_rate=25, imu_rate=100),
    Case('odom_50_imu_400', CARPET, MEDIUM, imu_rate=400),
    # kobuki_node, use_imu_heading false: odometry.cpp, slot_callbacks.cpp
    Case('kobuki', HARD, (0.1, 0.2), imu=(0.005, 0.005)),
    # create_node: covariances.py, turtlebot_node.py (update_rate), gyro.py (subtracts the bias from the rate)
    Case('create_node', CARPET, (1e-3, 1e3), odom_at_rest=(1e-9, 1e-9), imu=(1e-6, 1e-6), bias=0.0, odom_rate=30,
         imu_rate=30),
    # robot_localization, test1.bag: variances and rates of a Husky
    Case('husky', CARPET, MEDIUM, imu=(4e-4, 1.225e-3), bias=1.0, ratio=2.0, speed=1.0, odom_rate=10, imu_rate=30),
    # paths on two floors, with a rest before them, without any, and with odometry that restarts
    *(Case(f'{floor}_{path}{name}', SHORT[floor], MEDIUM, path=path, **changes)
      for floor in SHORT for path in ('circle', 'eights', 'squares', 'random')
      for name, changes in (('', {}), ('_no_rest', dict(rest=0.0)), ('_restart', dict(fault='restart')))),
    Case('carpet_legs_no_rest', CARPET, MEDIUM, rest=0.0),
    Case('skid_2_no_rest', CARPET, MEDIUM, ratio=2.0, rest=0.0, path='eights'),
    Case('husky_no_rest', CARPET, MEDIUM, imu=(4e-4, 1.225e-3), bias=1.0, ratio=2.0, speed=1.0, odom_rate=10,
         imu_rate=30, rest=0.0, path='random'),
    Case('scale_circle', CARPET, MEDIUM, scale=0.02, path='circle'),
    Case('large_covariances', HARD, (1e3, 1e3), path='random'),
    # faults
    Case('drift_straight', HARD, MEDIUM, bias=0.5, drift=0.5, path='straight'),
    Case('clipped', HARD, MEDIUM, path='spins'),
    Case('frozen', HARD, MEDIUM, path='squares', fault='frozen'),
    Case('wheel_spins', HARD, MEDIUM, path='squares', fault='spin'),
    Case('carried', HARD, MEDIUM, path='squares', fault='carried'))}
