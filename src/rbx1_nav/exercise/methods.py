"""The methods of the exercise, each declared once: programs, page and fleet offer what is declared here."""
from __future__ import annotations

from typing import NamedTuple, Tuple


class Method(NamedTuple):
    """A way to drive out and back."""

    name: str           # on command lines and in files
    title: str          # as displayed
    text: str           # when a motion stops, for --help
    pose: str           # what stops a motion: '' for its duration, or a pose: odometry or estimate
    script: str         # in nodes/
    arguments: Tuple[str, ...] = ()     # of the script; the master keeps a parameter of an earlier run

    @property
    def filtered(self) -> bool:
        """Whether the filter stops a motion."""
        return self.pose == 'estimate'


# by name
METHODS = {each.name: each for each in (
    Method(name='timed', title='timed', text='fixed durations, no feedback', pose='', script='timed_out_and_back.py'),
    Method(name='odom', title='with odometry', text='stops at the odometry goal', pose='odometry',
           script='odom_out_and_back.py', arguments=('_odom_frame:=odom',)),
    Method(name='ekf', title='with odometry and gyro', text='stops at the estimated goal', pose='estimate',
           script='odom_out_and_back.py', arguments=('_odom_frame:=odom_combined',)))}
