"""Makes plain rospy safe in a driving script: `from rbx1_nav.driving import Drive`, as the first import.

docs/the_script.md shows how to use it.
"""
import rbx1_nav.node.early_interrupt    # noqa: F401
from rbx1_nav.driving.script import Drive

__all__ = ['Drive']
