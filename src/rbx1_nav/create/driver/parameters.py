"""The parameters of the base node, with the names and the meaning of create_node's."""
from __future__ import annotations

from math import inf
from typing import NamedTuple

from rbx1_nav.config import AUTO, ConfigError, Section, YamlValue, show
from rbx1_nav.create import protocol
from rbx1_nav.create.driver.fractions import KINDS
from rbx1_nav.robot.description import Limits, Robot, read_wheel_joints
from rbx1_nav.robot.odometry import OdometryErrors
from rbx1_nav.units import SECOND

GYRO_CORRECTION = 1.35  # create_node's default
WHEEL_RADIUS = 0.033    # m, of the wheels that RViz shows


class Settings(NamedTuple):
    """What the driver depends on."""

    robot_type: str             # the name of a Model, or AUTO
    model: protocol.Model       # that is expected
    port: str
    baud: int | None            # bits per second, None to find out
    wake: bool                  # whether to wake a robot by RTS and DTR
    update_rate: float          # Hz
    mode: int                   # that in which the robot is driven
    mode_plus_one: bool | None  # whether it reports its mode plus one, None to find out
    has_gyro: bool
    gyro_range: float           # degrees/s
    gyro_correction: float
    linear_correction: float
    angular_correction: float
    angle_fractions: str        # see fractions.KINDS
    errors: OdometryErrors
    moving_yaw_variance: float  # rad^2, 0 for none
    stop_on_bump: bool
    min_yaw_speed: float        # rad/s


def read_settings(params: YamlValue) -> tuple[Settings, Robot]:
    """(Settings, Robot) from a dictionary of private parameters. Raises ConfigError."""
    section = Section(params)
    name = section.choice('robot_type', (AUTO, *protocol.MODELS), AUTO)
    model = protocol.MODELS.get(name, protocol.CREATE)
    port = section.get('port', '/dev/ttyUSB0')
    if not (isinstance(port, str) and port.startswith('/')):
        raise ConfigError(f'port: {show(port)}: expected the absolute path of a device')
    section.choice('drive_mode', ('twist',), 'twist')
    rates: tuple[int | str, ...] = (AUTO, *protocol.BAUD_RATES)
    baud = section.choice('baud', rates, AUTO)
    mode = section.get('operation_mode', protocol.SAFE)
    if (not isinstance(mode, (int, float)) or isinstance(mode, bool)
            or mode not in (protocol.PASSIVE, protocol.SAFE, protocol.FULL)):
        raise ConfigError(f'operation_mode: {show(mode)}: expected 1 (passive), 2 (safe) or 3 (full)')
    workarounds: tuple[bool | str, ...] = (AUTO, True, False)
    mode_plus_one = section.choice('oi_mode_workaround', workarounds, AUTO)
    has_gyro = section.flag('has_gyro', model is protocol.CREATE)
    if has_gyro and model is not protocol.CREATE:
        raise ConfigError(f'has_gyro: True: expected false, a {name} has no analog input for a gyro')
    settings = Settings(
        robot_type=name, model=model, port=port, baud=baud if isinstance(baud, int) else None,
        wake=section.flag('wake_robot', False), mode=int(mode),
        mode_plus_one=mode_plus_one if isinstance(mode_plus_one, bool) else None, has_gyro=has_gyro,
        angle_fractions=section.choice('angle_fractions', KINDS, AUTO),
        update_rate=section.number('update_rate', 5, 60, 30.0, 'a rate', 'Hz'),
        gyro_range=section.number('gyro_measurement_range', 1, 1000, 150.0, 'a rate', 'degrees/s'),
        gyro_correction=section.number('gyro_scale_correction', 0.01, 100, GYRO_CORRECTION, 'a factor'),
        linear_correction=section.number('odom_linear_scale_correction', 0.01, 100, 1.0, 'a factor'),
        angular_correction=section.number('odom_angular_scale_correction', 0.01, 100, 1.0, 'a factor'),
        errors=OdometryErrors(section.number('odom_linear_error', 0, 1, 0.05, 'a distance', 'm'),
                      section.number('odom_angular_error', 0, 1, 0.09, 'an angle', 'rad'),
                      section.number('odom_heading_error', 0, 1, 0.07, 'an angle', 'rad')),
        moving_yaw_variance=section.number('moving_yaw_variance', 0, 1e6, 0.0, 'a variance', 'rad^2'),
        stop_on_bump=section.flag('stop_motors_on_bump', True),
        min_yaw_speed=section.number('min_abs_yaw_vel', 0, 10, 0.0, 'a speed', 'rad/s'))
    # 0 is no limit, as in create_node
    max_yaw_speed = section.number('max_abs_yaw_vel', 0, 10, 0.0, 'a speed', 'rad/s') or inf
    if settings.min_yaw_speed > max_yaw_speed:
        raise ConfigError(f'min_abs_yaw_vel: {settings.min_yaw_speed!r}: expected at most max_abs_yaw_vel, '
                          f'{max_yaw_speed!r}')
    robot = Robot(
        name=name, odom_frame_id=section.frame('odom_frame', 'odom'),
        base_frame_id=section.frame('base_frame', 'base_footprint'), base_width=model.wheel_separation,
        wheel_radius=WHEEL_RADIUS, rate=settings.update_rate,
        timeout=round(SECOND * section.number('cmd_vel_timeout', 0.05, 10, 0.6, 'a time', 's')),
        limits=Limits(inf, max_yaw_speed), publish_tf=section.flag('publish_tf', True), joints=[],
        wheel_joints=read_wheel_joints(section), hardware=[], unknown=[])
    if robot.odom_frame_id == robot.base_frame_id:
        raise ConfigError(f'base_frame: {show(robot.base_frame_id)}: expected a frame other than odom_frame')
    return settings, robot
