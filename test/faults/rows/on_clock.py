"""Drivers on the clock in lockstep, as different as people write them: none is named, and every run of a driver takes
the same path."""
from rows.any_driver import check_all

FAULT = ('27 kinds of drivers on the clock: rospy.Rate, rospy.sleep, rospy.Timer, callbacks, transforms, threads, '
         'parameters, several publishers, at 5 to 50 Hz, at real_time_factor 20 with strict; in half of the runs '
         'beside six busy loops')
PROMISE = 'the end pose of a driver is the same in every run to the last bit, and the base names no driver'
FULL, SHORT = 4, 1      # runs of each kind of driver
ROOT, ALONE = False, True

KINDS = (
    'at_rate 5', 'at_rate 7', 'at_rate 20', 'at_rate 30', 'at_rate 50', 'sleeps 10', 'sleeps 7', 'timer 10',
    'timer 50', 'odom_callback', 'odom_callback 2', 'transform_loop', 'transform_callback', 'several_publishers',
    'waits_for_message', 'parameter', 'with_settings latched', 'with_settings unqueued', 'with_settings queue_1',
    'with_settings no_delay', 'motions', 'durations', 'thread', 'computes', 'reads_odom', 'one_command', 'roscpp sleep')


def run(row):
    """See FAULT."""
    check_all(row, KINDS, 'on_clock_driver.py')
