"""The parameters of the filter node, and the floor that it starts with."""
from __future__ import annotations

from math import degrees, radians
import time
from typing import Any, Callable, NamedTuple
import xmlrpc.client

from nav_msgs.msg import Odometry
import rosgraph
import rospy

from rbx1_nav.config import ConfigError, Section, YamlValue, show
from rbx1_nav.estimation.arrivals import MAX_AGE, MAX_LEAD
from rbx1_nav.estimation.combined_odometry import CombinedOdometry
from rbx1_nav.estimation.inputs import check
from rbx1_nav.estimation.limits import Limits
from rbx1_nav.estimation.priors import UNKNOWN_FLOOR, Priors, priors
from rbx1_nav.ros.network.master import call
from rbx1_nav.ros.node import resources
from rbx1_nav.simulation.surfaces import load_surface
from rbx1_nav.units import SECOND

AUTO = 'auto'       # the surface of the simulated base, or else
ANY = 'unknown'     # any floor
DEFAULT = Limits()


class FilterParameters(NamedTuple):
    """All parameters, with the names of robot_pose_ekf."""

    freq: float                 # Hz
    sensor_timeout: float       # s
    diagnostic_period: float    # s
    limits: Limits
    publish_tf: bool
    imu_used: bool
    output_frame: str
    base_footprint_frame: str   # '' unless it is set
    default_base_frame: str
    surface: str
    unsupported: list[str]      # a line for each that asks for what the filter does not do


def read_parameters(params: dict[str, YamlValue]) -> FilterParameters:
    """The FilterParameters from those that are set. Raises ConfigError."""
    section = Section(params)
    prefix = section.frame('tf_prefix', '/') if params.get('tf_prefix') else ''
    base_frame = _resolve(prefix, section.frame('base_footprint_frame', 'base_footprint'),
                          params.get('base_footprint_frame'))
    values = FilterParameters(
        freq=section.number('freq', 0.1, 1000, 30.0, 'a rate', 'Hz'),
        sensor_timeout=section.number('sensor_timeout', 0.01, 1e6, 1.0, 'a time', 's'),
        diagnostic_period=section.number('diagnostic_period', 0.1, 1e6, 1.0, 'a time', 's'),
        limits=Limits(
            section.number('max_speed', 0.01, 1000, DEFAULT.max_speed, 'a speed', 'm/s'),
            section.number('max_turn_rate', 0.01, 1000, DEFAULT.max_turn_rate, 'a turn rate', 'rad/s'),
            section.number('max_angular_acceleration', 0.01, 1e4, DEFAULT.max_angular_acceleration,
                           'an angular acceleration', 'rad/s^2'),
            radians(section.number('gyro_bias', 0.01, 1000, degrees(DEFAULT.gyro_bias), 'a bias', 'degrees/s')),
            section.number('gyro_scale_error', 0.0, 0.5, DEFAULT.gyro_scale_error, 'a fraction')),
        publish_tf=section.flag('publish_tf', True),
        imu_used=section.flag('imu_used', True),
        output_frame=_resolve(prefix, section.frame('output_frame', 'odom_combined'), params.get('output_frame')),
        base_footprint_frame=base_frame if 'base_footprint_frame' in params else '',
        default_base_frame=base_frame,
        surface=_read_surface(section),
        unsupported=[line for asked, line in [
            (section.flag('vo_used', False), 'vo_used: visual odometry is not supported, and not used'),
            (section.flag('gps_used', False), 'gps_used: GPS is not supported, and not used'),
            (section.flag('debug', False), 'debug: no files are written; record the topics with rosbag'),
            (section.flag('self_diagnose', False), 'self_diagnose: see /diagnostics')] if asked])
    if not section.flag('odom_used', True):
        raise ConfigError('odom_used: False: expected true, nothing else measures the distance')
    if values.base_footprint_frame and values.base_footprint_frame == values.output_frame:
        raise ConfigError(f'base_footprint_frame: {show(values.output_frame)}: expected a frame other than '
                          'output_frame')
    return values


def _read_surface(section: Section) -> str:
    name = section.get('surface', AUTO)
    if name not in (AUTO, ANY):
        try:
            load_surface(name, resources.surfaces())
        except ConfigError as error:
            raise ConfigError(f'{error}; or {AUTO}, or {ANY}') from None
    return str(name)


def load_parameters() -> FilterParameters:
    """read_parameters() of this node. As in tf, tf_prefix may also be set in a namespace around it.

    Logs what is asked for and not supported. Raises ROSException with one line.
    """
    params = rospy.get_param(rospy.get_name(), {})
    prefix = search_value('tf_prefix', rospy.get_name(), rospy.get_param)
    try:
        values = read_parameters(params if prefix is None else dict(params, tf_prefix=prefix))
    except ConfigError as error:
        raise rospy.ROSException(f'{rospy.get_name()}/{error}') from None
    for line in values.unsupported:
        rospy.logwarn('%s', line)
    return values


def frames_of(message: Odometry, parameters: FilterParameters) -> tuple[str, str]:
    """The frames of an Odometry message and of the robot, without leading slashes. Raises RejectedMessage.

    The output_frame cannot be the robot's own.
    """
    base_frame = parameters.base_footprint_frame or message.child_frame_id.lstrip('/') or (
        parameters.default_base_frame)
    frames = message.header.frame_id.lstrip('/'), base_frame
    for field, frame in zip(('header.frame_id', 'child_frame_id'), frames):
        check(field, show(frame), frame, 'the name of a frame')
    check('child_frame_id', show(frames[1]), frames[1] != parameters.output_frame, 'a frame other than output_frame')
    return frames


# Any: whatever the parameter is
def search_value(key: str, node: str, get: Callable[[str, None], Any]) -> Any:
    """The value of a parameter of a node or of the nearest namespace around it, None if there is none.

    Unlike rospy.search_param(), it passes over a namespace that has the name of the parameter. get: rospy.get_param.
    """
    while node:
        value = get(rosgraph.names.ns_join(node, key), None)
        if value is not None and not isinstance(value, dict):
            return value
        node = '' if node == '/' else rosgraph.names.namespace(node).rstrip('/') or '/'
    return None


def _resolve(prefix: str, frame: str, given: YamlValue) -> str:
    """A frame with the prefix. given: as in the parameter, where a leading slash means that it has none."""
    return f'{prefix}/{frame}' if prefix and not str(given).startswith('/') else frame


Log = Callable[[Callable[..., None], str], None]     # a function of rospy, such as loginfo, and a text


def find_prior(name: str, base: str, log: Log) -> Priors:
    """The Priors of the surface of this name, UNKNOWN_FLOOR for ANY; for AUTO, those of the surface of the node
    `base`, which has a parameter `surface` if it is simulated, or else UNKNOWN_FLOOR."""
    try:
        if name == AUTO:
            key, master = f'{base}/surface', rosgraph.get_master_uri()
            # not by rospy, which waits for a frozen master for ever
            name = call(master, 'getParam', key) if call(master, 'hasParam', key) else ANY
        prior = UNKNOWN_FLOOR if name == ANY else priors(load_surface(name, resources.surfaces()))
    except (ConfigError, OSError, xmlrpc.client.Error) as error:     # or no answer from the master
        log(rospy.logwarn, f'{base}/{error}; using {ANY} instead')
        name, prior = ANY, UNKNOWN_FLOOR
    log(rospy.loginfo, f'Floor that the filter starts with: {name}')
    return prior


def make_filter(parameters: FilterParameters, base: str, log: Log, warn: Callable[[str], None]) -> CombinedOdometry:
    """The CombinedOdometry for the odometry of the node `base`. warn(text): logs a warning."""
    return CombinedOdometry(find_prior(parameters.surface, base, log), round(SECOND * parameters.sensor_timeout),
                            parameters.imu_used, warn, time.monotonic_ns,
                            MAX_LEAD if rospy.rostime.is_wallclock() else MAX_AGE, parameters.limits)
