"""Parameters of the base node. Their names and meanings match create_node."""
from __future__ import annotations

from math import inf
from typing import NamedTuple

from rbx1_nav.base.covariances import OdometryErrors
from rbx1_nav.base.robot_parameters import MODEL, WHEEL_JOINTS, Limits, Robot, read_wheel_joints
from rbx1_nav.base.units import SECOND
from rbx1_nav.extras.create import protocol
from rbx1_nav.extras.create.angle_fractions import KINDS
from rbx1_nav.node.config import AUTO, ConfigError, Section, YamlValue, show
from rbx1_nav.node.parameters import choice, custom, elsewhere, flag, frame, number, read

WHEEL_RADIUS = 0.033    # m, radius of the wheels in RViz


def _check_port(port: YamlValue) -> str:
    if not (isinstance(port, str) and (port.startswith('/') or port == AUTO)):
        raise ConfigError(f'port: {show(port)}: expected the absolute path of a device, or auto')
    return port


PARAMETERS = (
    custom('port', AUTO, 'serial port, or a link to it; auto: /dev/create if it exists, else /dev/ttyUSB0',
           _check_port),
    choice('robot_type', (AUTO, *protocol.MODELS), AUTO, 'robot model; auto: detect it'),
    choice('baud', (AUTO, *protocol.BAUD_RATES), AUTO, 'rate of the serial port; auto: tries 57600, 115200 and 19200',
           'bits per second')._replace(range=f'auto, {protocol.BAUD_RANGE}'),
    number('update_rate', 30.0, 'Hz', 'rate of sensor readings, odometry and repeated commands', 5, 60, 'a rate'),
    choice('operation_mode', (protocol.PASSIVE, protocol.SAFE, protocol.FULL), protocol.SAFE,
           'mode in which the robot is driven; 1: passive, not driven; 2: safe; 3: full, without a stop at a cliff or '
           'a wheel drop'),
    flag('oi_mode_workaround', None, 'whether the robot reports its mode plus one, as some Roombas do',
         shown='false; roomba600_wifi: true'),
    flag('wake_robot', False, 'whether to wake a robot that does not answer, using RTS and DTR'),
    number('cmd_vel_timeout', 0.6, 's', 'age at which a command expires and the robot stops', 0.05, 10, 'a time'),
    flag('stop_motors_on_bump', True, 'whether the bumper stops forward motion'),
    number('min_abs_yaw_vel', 0.0, 'rad/s', 'minimum turning speed; slower turns are raised to it', 0, 10, 'a speed'),
    number('max_abs_yaw_vel', 0.0, 'rad/s', 'maximum turning speed; 0: no limit', 0, 10, 'a speed'),
    flag('has_gyro', None, 'whether a gyro is connected to the analog input', shown='create: true; others: false'),
    number('gyro_measurement_range', 150.0, 'degrees/s', 'measurement range of the gyro chip', 1, 1000, 'a rate'),
    number('gyro_scale_correction', 1.35, '', 'factor for the angular velocity of the gyro', 0.01, 100, 'a factor'),
    number('odom_linear_scale_correction', 1.0, '', 'factor for the distance that the robot reports', 0.01, 100,
           'a factor'),
    number('odom_angular_scale_correction', 1.0, '', 'factor for the angle that the robot reports', 0.01, 100,
           'a factor'),
    choice('angle_fractions', KINDS, AUTO,
           'whether the robot keeps or loses fractions of a degree; auto: allow for either',
           note='test: calibrate_angular.py finds out'),
    number('odom_linear_error', 0.05, 'm', 'error of the calibrated distance, 1 sigma after 1 m', 0, 1, 'a distance'),
    number('odom_angular_error', 0.09, 'rad', 'error of the calibrated angle, 1 sigma after 1 rad', 0, 1, 'an angle'),
    number('odom_heading_error', 0.07, 'rad', 'error of the heading, 1 sigma after 1 m', 0, 1, 'an angle'),
    number('moving_yaw_variance', 0.0, 'rad^2', 'variance of the heading while the robot moves; 0: calculated', 0, 1e6,
           'a variance'),
    frame('odom_frame', 'odom', 'frame of the odometry'),
    frame('base_frame', 'base_footprint', 'frame of the robot'),
    elsewhere('left_wheel', 'joint of the left wheel in the URDF', WHEEL_JOINTS['left_wheel']),
    elsewhere('right_wheel', 'joint of the right wheel', WHEEL_JOINTS['right_wheel']),
    flag('publish_tf', True, 'whether to publish the transform from odom_frame to base_frame',
         note='false if another node publishes it'),
    MODEL,
    choice('drive_mode', ('twist',), 'twist', 'the only drive mode'),
    elsewhere('diagnostic_period', 'accepted and ignored'))


class Settings(NamedTuple):
    """The settings of the driver: the parameters with these names, and what follows from them."""

    robot_type: str             # name of a Model, or AUTO
    model: protocol.Model       # expected model
    port: str                   # path, or AUTO
    baud: int | None            # bits per second; None: detect it
    wake_robot: bool
    update_rate: float          # Hz
    operation_mode: int
    oi_mode_workaround: bool | None     # None: as the model does
    has_gyro: bool
    gyro_measurement_range: float   # degrees/s
    gyro_scale_correction: float
    odom_linear_scale_correction: float
    odom_angular_scale_correction: float
    angle_fractions: str        # see fractions.KINDS
    errors: OdometryErrors
    moving_yaw_variance: float  # rad^2, 0 for none
    stop_motors_on_bump: bool
    min_abs_yaw_vel: float      # rad/s


def read_settings(params: YamlValue) -> tuple[Settings, Robot]:
    """Return (Settings, Robot) for a dictionary of private parameters. Raises ConfigError."""
    section = Section(params)
    values = read(PARAMETERS, section)
    name = values['robot_type']
    model = protocol.MODELS.get(name, protocol.CREATE)
    has_gyro = model.has_gyro_board if values['has_gyro'] is None else values['has_gyro']
    if has_gyro and not model.has_gyro_board:
        raise ConfigError(f'has_gyro: True: expected false, because a {name} has no analog input for a gyro')
    mode = values['operation_mode']
    if mode != protocol.PASSIVE and not model.has(protocol.MODE_NAMES[mode]):
        raise ConfigError(f'operation_mode: {mode}: expected another mode, because a {name} has no '
                          f'{protocol.MODE_NAMES[mode]} mode')
    values.update(model=model, has_gyro=has_gyro, baud=None if values['baud'] == AUTO else values['baud'],
                  errors=OdometryErrors(*(values[f'odom_{each}_error'] for each in OdometryErrors._fields)))
    settings = Settings(**{name: values[name] for name in Settings._fields})
    max_yaw_speed = values['max_abs_yaw_vel'] or inf    # 0 means no limit, as in create_node
    if settings.min_abs_yaw_vel > max_yaw_speed:
        raise ConfigError(f'min_abs_yaw_vel: {settings.min_abs_yaw_vel!r}: expected at most max_abs_yaw_vel, '
                          f'{max_yaw_speed!r}')
    robot = Robot(
        name=name, odom_frame_id=values['odom_frame'], base_frame_id=values['base_frame'],
        base_width=model.wheel_separation, wheel_radius=WHEEL_RADIUS, rate=settings.update_rate,
        timeout=round(SECOND * values['cmd_vel_timeout']), limits=Limits(linear=inf, angular=max_yaw_speed),
        publish_tf=values['publish_tf'], joints=[],
        wheel_joints=read_wheel_joints(section), model=values['model'], hardware=[], unknown=[])
    if robot.odom_frame_id == robot.base_frame_id:
        raise ConfigError(f'base_frame: {show(robot.base_frame_id)}: expected a frame other than odom_frame')
    return settings, robot
