"""What a driving script begins with. Ctrl-C ends it quietly even while the rest is loaded: so import this first."""
import rbx1_nav.ros.node.early_interrupt    # noqa: F401

from typing import Sequence

from rbx1_nav.control.motions import whole_ticks
from rbx1_nav.parameters import Parameter, frame, number
from rbx1_nav.ros.driving.drive import TimedDrive
from rbx1_nav.ros.node import life
from rbx1_nav.ros.node.exit_status import exit_status
from rbx1_nav.ros.node.params import param

__all__ = ['TimedDrive', 'exit_status', 'frame', 'init_node', 'number', 'param', 'whole_ticks']

WAIT_TIMEOUT = number('wait_timeout', 30, 's', 'how long to wait for roscore, and then for the base and its pose',
                      note='wall time')


def init_node(name: str, usage: str, parameters: Sequence[Parameter] = ()) -> None:
    """Start the node `name` of a driving script, as life.init_node(). It has ~wait_timeout, too."""
    life.init_node(name, usage, (*parameters, WAIT_TIMEOUT))
