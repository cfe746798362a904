"""The parameters of the filter node, and the floor that it starts with."""
import xmlrpc.client

import rosgraph
import rospy

from rbx1_nav.config import ConfigError, Section
from rbx1_nav.estimation.filter import UNKNOWN, priors
from rbx1_nav.model.surfaces import load_surface
from rbx1_nav.ros import resources
from rbx1_nav.ros.master import call

AUTO = 'auto'       # the surface of the simulated base, or else
ANY = 'unknown'     # any floor


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
    if values['surface'] not in (AUTO, ANY):
        load_surface(values['surface'], resources.surfaces())
    return values


def find_prior(name, base, log):
    """The Priors of the surface of this name, UNKNOWN for ANY; for AUTO, those of the surface of the node `base`, which
    has a parameter `surface` if it is simulated, or else UNKNOWN. log(function, text): logs a line.
    """
    try:
        if name == AUTO:
            key, master = base + '/surface', rosgraph.get_master_uri()
            # not by rospy, which waits for a frozen master for ever
            name = call(master, 'getParam', key) if call(master, 'hasParam', key) else ANY
        prior = UNKNOWN if name == ANY else priors(load_surface(name, resources.surfaces()))
    except (ConfigError, OSError, xmlrpc.client.Error) as error:     # or no answer from the master
        log(rospy.logwarn, '%s/%s; using %s instead' % (base, error, ANY))
        name, prior = ANY, UNKNOWN
    log(rospy.loginfo, 'Floor that the filter starts with: %s' % name)
    return prior
