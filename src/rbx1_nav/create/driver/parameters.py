"""The parameters of the base node, with the names and the meaning of create_node's."""
from collections import namedtuple
from math import inf

from rbx1_nav.config import AUTO, ConfigError, Section, show
from rbx1_nav.create import protocol
from rbx1_nav.create.driver.fractions import KINDS
from rbx1_nav.robot.description import Limits, Robot, read_wheel_joints
from rbx1_nav.robot.odometry import OdometryErrors
from rbx1_nav.units import SECOND

GYRO_CORRECTION = 1.35  # create_node's default
WHEEL_RADIUS = 0.033    # m, of the wheels that RViz shows

Settings = namedtuple('Settings', 'robot_type model port baud wake update_rate mode mode_plus_one has_gyro gyro_range '
                                  'gyro_correction linear_correction angular_correction angle_fractions errors '
                                  'moving_yaw_variance stop_on_bump min_yaw_speed')
Settings.__doc__ = """What the driver depends on. robot_type: a name of a Model, or AUTO; model: the Model that is expected;
baud: bits per second, None to find out; wake: whether to wake a robot by RTS and DTR; update_rate in Hz; mode: that in which
the robot is driven; mode_plus_one: whether it reports its mode plus one, None to find out; gyro_range in degrees/s;
angle_fractions: see fractions.KINDS; errors: OdometryErrors; moving_yaw_variance in rad^2, 0 for none; min_yaw_speed in rad/s."""


def read_settings(params):
    """(Settings, Robot) from a dictionary of private parameters. Raises ConfigError."""
    section = Section(params)
    name = section.choice('robot_type', (AUTO, *protocol.MODELS), AUTO)
    model = protocol.MODELS.get(name, protocol.CREATE)
    port = section.get('port', '/dev/ttyUSB0')
    if not (isinstance(port, str) and port.startswith('/')):
        raise ConfigError(f'port: {show(port)}: expected the absolute path of a device')
    section.choice('drive_mode', ('twist',), 'twist')
    baud = section.choice('baud', (AUTO, *protocol.BAUD_RATES), AUTO)
    mode = section.get('operation_mode', protocol.SAFE)
    if mode not in (protocol.PASSIVE, protocol.SAFE, protocol.FULL) or isinstance(mode, bool):
        raise ConfigError(f'operation_mode: {show(mode)}: expected 1 (passive), 2 (safe) or 3 (full)')
    mode_plus_one = section.choice('oi_mode_workaround', (AUTO, True, False), AUTO)
    has_gyro = section.flag('has_gyro', model is protocol.CREATE)
    if has_gyro and model is not protocol.CREATE:
        raise ConfigError(f'has_gyro: True: expected false, a {name} has no analog input for a gyro')
    settings = Settings(
        robot_type=name, model=model, port=port, baud=None if baud == AUTO else baud,
        wake=section.flag('wake_robot', False), mode=int(mode),
        mode_plus_one=None if mode_plus_one == AUTO else mode_plus_one, has_gyro=has_gyro,
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
        raise ConfigError('min_abs_yaw_vel: %r: expected at most max_abs_yaw_vel, %r'
                          % (settings.min_yaw_speed, max_yaw_speed))
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
