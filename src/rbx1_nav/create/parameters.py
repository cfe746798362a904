"""The parameters of the base node, with the names and the meaning of create_node's."""
from collections import namedtuple
from math import inf

from rbx1_nav.config import ConfigError, Section, show
from rbx1_nav.create import protocol
from rbx1_nav.create.odometry import Errors
from rbx1_nav.model.robot import Limits, Robot
from rbx1_nav.units import SECOND

WHEEL_RADIUS = 0.033    # m, of the wheels that RViz shows

Settings = namedtuple('Settings', 'model port update_rate mode has_gyro gyro_range gyro_correction linear_correction '
                                  'angular_correction errors stop_on_bump min_yaw_speed')
Settings.__doc__ = """What the driver depends on. model: a Model; update_rate in Hz; mode: that in which the robot is
driven; gyro_range in degrees/s; errors: Errors; min_yaw_speed in rad/s."""


def read_settings(params):
    """(Settings, Robot) from a dictionary of private parameters. Raises ConfigError."""
    section = Section(params)
    name = section.get('robot_type', 'create')
    if not (isinstance(name, str) and name in protocol.MODELS):
        raise ConfigError('robot_type: %s: expected one of: %s' % (show(name), ', '.join(protocol.MODELS)))
    model = protocol.MODELS[name]
    port = section.get('port', '/dev/ttyUSB0')
    if not (isinstance(port, str) and port.startswith('/')):
        raise ConfigError('port: %s: expected the absolute path of a device' % show(port))
    if section.get('drive_mode', 'twist') != 'twist':
        raise ConfigError('drive_mode: %s: expected twist, the only one here' % show(params['drive_mode']))
    mode = section.get('operation_mode', protocol.SAFE)
    if mode not in (protocol.PASSIVE, protocol.SAFE, protocol.FULL) or isinstance(mode, bool):
        raise ConfigError('operation_mode: %s: expected 1 (passive), 2 (safe) or 3 (full)' % show(mode))
    has_gyro = section.flag('has_gyro', model is protocol.CREATE)
    if has_gyro and model is not protocol.CREATE:
        raise ConfigError('has_gyro: True: expected false, a %s has no analog input for a gyro' % name)
    settings = Settings(
        model=model, port=port, mode=int(mode), has_gyro=has_gyro,
        update_rate=section.number('update_rate', 5, 60, 30.0, 'a rate', 'Hz'),
        gyro_range=section.number('gyro_measurement_range', 1, 1000, 150.0, 'a rate', 'degrees/s'),
        gyro_correction=section.number('gyro_scale_correction', 0.01, 100, 1.35, 'a factor'),
        linear_correction=section.number('odom_linear_scale_correction', 0.01, 100, 1.0, 'a factor'),
        angular_correction=section.number('odom_angular_scale_correction', 0.01, 100, 1.0, 'a factor'),
        errors=Errors(section.number('odom_linear_error', 0, 1, 0.05, 'a distance', 'm'),
                      section.number('odom_angular_error', 0, 1, 0.09, 'an angle', 'rad'),
                      section.number('odom_heading_error', 0, 1, 0.07, 'an angle', 'rad')),
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
        hardware=[], unknown=[])
    if robot.odom_frame_id == robot.base_frame_id:
        raise ConfigError('base_frame: %s: expected a frame other than odom_frame' % show(robot.base_frame_id))
    return settings, robot
