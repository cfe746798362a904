"""The parameters of the filter node, and the surface that its initial uncertainties come from."""
import xmlrpc.client

import rosgraph
import rospy

from rbx1_nav.config import ConfigError, Section
from rbx1_nav.model.surfaces import load_surface
from rbx1_nav.ros import resources
from rbx1_nav.ros.master import call

AUTO = 'auto'       # the surface of the simulated base, or else
DEFAULT_SURFACE = 'low_ply_carpet'


def read_parameters(params):
    """A dictionary of all parameters, with the names that robot_pose_ekf gives them, from those that are set.

    Raises ConfigError.
    """
    section = Section(params)
    values = dict(
        freq=section.number('freq', 0.1, 1000, 10.0, 'a rate', 'Hz'),
        sensor_timeout=section.number('sensor_timeout', 0.01, 1e6, 1.0, 'a time', 's'),
        diagnostic_period=section.number('diagnostic_period', 0.1, 1e6, 1.0, 'a time', 's'),
        publish_tf=section.flag('publish_tf', True),
        imu_used=section.flag('imu_used', True),
        output_frame=section.frame('output_frame', 'odom'),
        surface=section.get('surface', AUTO))
    if not section.flag('odom_used', True):
        raise ConfigError('odom_used: False: expected true, nothing else measures the distance')
    if section.flag('vo_used', False):
        raise ConfigError('vo_used: True: expected false, visual odometry is not supported')
    if values['surface'] != AUTO:
        load_surface(values['surface'], resources.surfaces())
    return values


def find_surface(name, base, log):
    """The Surface of this name; for AUTO, that of the node `base`, or else DEFAULT_SURFACE.

    A simulated base has a parameter `surface`; a real one is assumed to stand on carpet, like the tutorial's.
    log(function, text): logs a line.
    """
    try:
        if name == AUTO:
            key, master = base + '/surface', rosgraph.get_master_uri()
            # not by rospy, which waits for a frozen master for ever
            name = call(master, 'getParam', key) if call(master, 'hasParam', key) else DEFAULT_SURFACE
        surface = load_surface(name, resources.surfaces())
    except (ConfigError, OSError, xmlrpc.client.Error) as error:     # or no answer from the master
        log(rospy.logwarn, '%s/%s; using %s instead' % (base, error, DEFAULT_SURFACE))
        name, surface = DEFAULT_SURFACE, load_surface(DEFAULT_SURFACE, resources.surfaces())
    log(rospy.loginfo, 'Initial uncertainties of wheels and gyro: as on %s' % name)
    return surface
