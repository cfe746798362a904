"""Common imports of driving scripts. Import this first, so that Ctrl-C during the other imports exits quietly."""
import rbx1_nav.ros.node.early_interrupt    # noqa: F401

from math import pi, radians
from typing import Sequence

import rospy

from rbx1_nav.control.motions import whole_ticks
from rbx1_nav.parameters import Parameter, frame, number
from rbx1_nav.ros.driving.drive import TimedDrive
from rbx1_nav.ros.node import life
from rbx1_nav.ros.node.exit_status import exit_status
from rbx1_nav.ros.node.params import param

__all__ = ['TimedDrive', 'exit_status', 'frame', 'init_node', 'number', 'param', 'whole_ticks']

WAIT_TIMEOUT = number('wait_timeout', 30, 's', 'maximum wait for roscore, and then for the base and its pose',
                      note='wall time')
MANY_TURNS = 4 * pi     # rad: an angle above this was probably meant in degrees


def init_node(name: str, usage: str, parameters: Sequence[Parameter] = ()) -> None:
    """Start the node `name` of a driving script, like life.init_node(), with the additional parameter ~wait_timeout."""
    life.init_node(name, usage, (*parameters, WAIT_TIMEOUT))
    for each in parameters:
        angle = param(each.name) if each.unit == 'rad' else 0.0
        if angle > MANY_TURNS:
            rospy.logwarn('%s/%s: %g: %.1f turns, because the unit is radians. For %g degrees: _%s:=%.6g',
                          rospy.get_name(), each.name, angle, angle / (2 * pi), angle, each.name, radians(angle))
