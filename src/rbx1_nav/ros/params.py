"""Private parameters of a node, checked as they are read."""
import rospy

from rbx1_nav.config import ConfigError, Section


def positive_param(name, default, low=1e-6, high=1e6):
    """The private parameter `name`, a number from `low` to `high`. Raises ROSException with one line if it is not."""
    try:
        return Section({name: rospy.get_param('~' + name, default)}).number(name, low, high)
    except ConfigError as error:
        raise rospy.ROSException('%s/%s' % (rospy.get_name(), error))


def frame_param(name, default):
    """The private parameter `name`, a frame without a leading slash. Raises ROSException with one line if it is not.

    default: may also be None.
    """
    if not rospy.has_param('~' + name):
        return default
    try:
        return Section({name: rospy.get_param('~' + name)}).frame(name, '')
    except ConfigError as error:
        raise rospy.ROSException('%s/%s' % (rospy.get_name(), error))
