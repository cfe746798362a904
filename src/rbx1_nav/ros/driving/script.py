"""What a driving script begins with. Ctrl-C ends it quietly even while the rest is loaded: so import this first."""
import rbx1_nav.ros.node.early_interrupt    # noqa: F401

from rbx1_nav.control.motions import whole_ticks
from rbx1_nav.ros.driving.drive import TimedDrive
from rbx1_nav.ros.node.exit_status import exit_status
from rbx1_nav.ros.node.life import init_node
from rbx1_nav.ros.node.params import frame_param, positive_param

__all__ = ['TimedDrive', 'exit_status', 'frame_param', 'init_node', 'positive_param', 'whole_ticks']
