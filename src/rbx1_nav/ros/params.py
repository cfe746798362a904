"""Private parameters of a node, checked as they are read."""
import rospy

from rbx1_nav.config import ConfigError, Section, positive


def positive_param(name, default):
    """The private parameter `name`, a finite number above 0. Raises ROSException with one line if it is not."""
    try:
        return positive(name, rospy.get_param('~' + name, default))
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
