"""The parameters of the filter node, and the floor that it assumes initially."""
from __future__ import annotations

from math import degrees, radians
import time
from types import SimpleNamespace
from typing import Callable
import xmlrpc.client

import rosgraph
import rospy

from rbx1_nav.base.running_bases import private_namespace
from rbx1_nav.base.surfaces import load_surface
from rbx1_nav.base.units import SECOND
from rbx1_nav.filter.combined_odometry import CombinedOdometry
from rbx1_nav.filter.priors import UNKNOWN_FLOOR, Bounds, Priors, priors
from rbx1_nav.filter.sensor_timeouts import MAX_AGE, MAX_LEAD
from rbx1_nav.node import resources
from rbx1_nav.node.config import AUTO, ConfigError, Section, YamlValue, show
from rbx1_nav.node.master import Server
from rbx1_nav.node.parameters import custom, flag, frame, number, read
from rbx1_nav.node.private_parameters import named_errors, stored_params
from rbx1_nav.node.tf_prefix import check_prefix, find_prefix, with_prefix

ANY = 'unknown'     # any floor; AUTO is the surface of a simulated base, otherwise ANY
DEFAULT = Bounds()

# parameters of robot_pose_ekf, each with a log line that explains why it has no effect
UNSUPPORTED = {
    'vo_used': 'visual odometry is not supported and not used',
    'gps_used': 'GPS is not supported and not used',
    'debug': 'no files are written; record the topics with rosbag',
    'self_diagnose': 'see /diagnostics'}


def _check_surface(name: YamlValue) -> str:
    if name not in (AUTO, ANY):
        try:
            load_surface(name, resources.surfaces())
        except ConfigError as error:
            raise ConfigError(f'{error}; or {AUTO}, or {ANY}') from None
    return str(name)


PARAMETERS = (
    number('freq', 30.0, 'Hz', 'publish rate of ~odom_combined and its transform', 0.1, 1000, 'a rate',
           note='`odom_ekf.launch` sets 10'),
    number('sensor_timeout', 1.0, 's',
           'silence after which a sensor is not used until it recovers', 0.01, 1e6, 'a time'),
    flag('publish_tf', True, 'whether to publish the transform'),
    flag('imu_used', True, 'whether to use the gyro'),
    flag('odom_used', True, 'whether to use the odometry; only true is accepted'),
    frame('output_frame', 'odom_combined', 'frame of the estimated pose'),
    frame('base_footprint_frame', None, 'frame of the robot',
          shown='child_frame_id of odom, or base_footprint if that is empty'),
    custom('tf_prefix', '', 'prefix of both frame names, unless they begin with a slash', check_prefix, shown='none',
           note='may also be set in a namespace around the node, as in tf'),
    custom('surface', AUTO,
           f'initially assumed floor: a name or path, {ANY}, or {AUTO}: the surface of a simulated base, or else {ANY}',
           _check_surface, note='see [surface files](reference.md#surface-files)'),
    number('max_speed', DEFAULT.max_speed, 'm/s', 'speed above which the odometry has jumped', 0.01, 1000, 'a speed'),
    number('max_turn_rate', DEFAULT.max_turn_rate, 'rad/s',
           'turn rate above which the odometry has jumped', 0.01, 1000, 'a turn rate',
           note='on an `unknown` floor, gyro readings above it are not used'),
    number('max_angular_acceleration', DEFAULT.max_angular_acceleration, 'rad/s^2',
           'highest angular acceleration while gyro readings are missing', 0.01, 1e4, 'an angular acceleration',
           note='see [Unexpected messages](#unexpected-messages)'),
    number('gyro_bias', degrees(DEFAULT.gyro_bias), 'degrees/s', 'largest gyro bias in either direction', 0.01, 1000,
           'a bias', note='5 % of it is the standard deviation of the bias before the first rest'),
    number('gyro_scale_error', DEFAULT.gyro_scale_error, '',
           "standard deviation of the gyro's scale error on an unknown floor", 0, 0.5, 'a fraction',
           note='a surface file contains its own value'),
    number('diagnostic_period', 1.0, 's', 'publish period of /diagnostics', 0.1, 1e6, 'a time'),
    *(flag(name, False, 'parameter of robot_pose_ekf, without effect') for name in UNSUPPORTED))


def read_parameters(params: dict[str, YamlValue]) -> SimpleNamespace:
    """Return the values of all parameters, by name, if `params` are set. Raises ConfigError.

    The frames have the prefix; base_footprint_frame is '' unless it is set, and default_base_frame is its default. The
    Bounds are `limits`. `unsupported` has a log line for each parameter that requests an unsupported feature.
    """
    given = read(PARAMETERS, Section(params))
    if not given['odom_used']:
        raise ConfigError('odom_used: False: expected true, because nothing else measures the distance')
    base_frame = _resolve(given['tf_prefix'], given['base_footprint_frame'] or 'base_footprint',
                          params.get('base_footprint_frame'))
    given.update(
        limits=Bounds(**{**{name: given[name] for name in Bounds._fields}, 'gyro_bias': radians(given['gyro_bias'])}),
        output_frame=_resolve(given['tf_prefix'], given['output_frame'], params.get('output_frame')),
        base_footprint_frame=base_frame if 'base_footprint_frame' in params else '',
        default_base_frame=base_frame,
        unsupported=[f'{name}: {reason}' for name, reason in UNSUPPORTED.items() if given[name]])
    if given['base_footprint_frame'] == given['output_frame']:
        raise ConfigError(f"base_footprint_frame: {show(given['output_frame'])}: expected a frame other than "
                          'output_frame')
    return SimpleNamespace(**given)


def load_parameters() -> SimpleNamespace:
    """Read the parameters of this node. As in tf, tf_prefix may also be set in a namespace around it.

    Logs requests for unsupported features. Raises ROSException with one line.
    """
    params = stored_params()
    prefix = find_prefix()
    with named_errors(rospy.get_name()):
        values = read_parameters(params if prefix is None else dict(params, tf_prefix=prefix))
    for line in values.unsupported:
        rospy.logwarn('%s', line)
    return values


def _resolve(prefix: str, frame: str, given: YamlValue) -> str:
    """Return a frame with the prefix. given: the value of the parameter; a leading slash means no prefix."""
    return frame if str(given).startswith('/') else with_prefix(prefix, frame)


Log = Callable[[Callable[..., None], str], None]     # a function of rospy, such as loginfo, and a text


def find_prior(name: str, base: str, log: Log) -> Priors:
    """Return the Priors of the surface with this name, or UNKNOWN_FLOOR for ANY.

    AUTO selects the surface of the node `base`, which has a parameter `surface` if it is simulated; otherwise the
    result is UNKNOWN_FLOOR.
    """
    try:
        if name == AUTO:
            with Server(rosgraph.get_master_uri()) as master:   # rospy waits for a frozen master indefinitely
                namespace = private_namespace(base, rospy.resolve_name('odom'), master)
                name = master.param(f'{namespace}/surface', ANY)
        prior = UNKNOWN_FLOOR if name == ANY else priors(load_surface(name, resources.surfaces()))
    except (ConfigError, OSError, xmlrpc.client.Error) as error:     # or no answer from the master
        log(rospy.logwarn, f'{base}/{error}; using {ANY} instead')
        name, prior = ANY, UNKNOWN_FLOOR
    log(rospy.loginfo, f'Initially assumed floor: {name}')
    return prior


def make_filter(parameters: SimpleNamespace, base: str, log: Log, warn: Callable[[str], None]) -> CombinedOdometry:
    """Return the CombinedOdometry for the odometry of the node `base`. warn(text): logs a warning."""
    return CombinedOdometry(find_prior(parameters.surface, base, log), round(SECOND * parameters.sensor_timeout),
                            parameters.imu_used, warn, time.monotonic_ns,
                            MAX_LEAD if rospy.rostime.is_wallclock() else MAX_AGE, parameters.limits)
