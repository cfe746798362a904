"""The methods of the exercise, each declared once.

A new script also needs its drive in extras/many_runs/simulated_run.py; the page has a button for each method, in
web/index.html.
"""
from __future__ import annotations

from typing import NamedTuple, Tuple


class Method(NamedTuple):
    """A way to drive out and back."""

    name: str           # on the command line of simulate.py, and in its files
    title: str          # as displayed
    text: str           # when a motion stops, for --help
    page_name: str      # in the messages of the page, and as a parameter of the fleet
    pose: str           # what stops a motion: '' for its duration, or a pose: odometry or estimate
    script: str         # in nodes/
    arguments: Tuple[str, ...] = ()     # of the script; the master keeps a parameter of an earlier run


# by name
METHODS = {each.name: each for each in (
    Method(name='timed', title='timed', text='fixed durations, no feedback', page_name='timed', pose='',
           script='timed_out_and_back.py'),
    Method(name='odom', title='with odometry', text='stops at the odometry goal', page_name='odometry', pose='odometry',
           script='odom_out_and_back.py', arguments=('_odom_frame:=odom',)),
    Method(name='ekf', title='with odometry and gyro', text='stops at the estimated goal', page_name='gyro',
           pose='estimate', script='odom_out_and_back.py', arguments=('_odom_frame:=odom_combined',)))}
OF_PAGE = {each.page_name: each for each in METHODS.values()}
