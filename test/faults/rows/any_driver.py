"""The start of drivers as people write them, in lockstep: every run of a driver takes the same path."""
import os

import rospy
from nav_msgs.msg import Odometry

from rows.in_step_feedback import Base
import support

FAULT = ('drivers that do not wait for the time: a Rate before a wall-time sleep, before a connection, odometry or a '
         'transform; a publisher that is created late; relay and throttle of topic_tools; in rospy and roscpp, at '
         'real_time_factor 20 with strict; in every second run beside six busy loops')
PROMISE = 'the end pose of a driver is the same in every run to the last bit, and the base names no driver'
# runs of each kind of driver; not in the short form, because 1 run in 20 of some kinds differs beside busy loops
FULL, SHORT = 10, 0
ROOT, ALONE = False, True

FOLDER = os.path.join(os.path.dirname(support.__file__), 'base')
BUSY = 6        # loops
KINDS = (
    'early', 'early 2.9', 'connection', 'no_wait', 'first_odom', 'first_transform', 'GoToPoint', 'Square', 'exercise',
    'late',
    'through relay', 'through throttle', 'roscpp sleep', 'roscpp connection', 'roscpp none')
# nodes between the driver and the base
TOOLS = {'relay': ('relay', '/relay', '/cmd_vel', '__name:=relay'),
         'throttle': ('throttle', 'messages', '/throttle', '100', '/cmd_vel', '__name:=throttle')}


def run(row):
    """See FAULT."""
    check_all(row, KINDS, 'any_driver.py')


def check_all(row, kinds, driver):
    """Run each kind of driver so many times. driver: file of the rospy drivers."""
    row.roscore()
    support.init_node('faults')
    base = Base(row, False)
    for kind in kinds:
        words = kind.split()
        tool = words[-1] if words[-1] in TOOLS else None
        ends = {}       # by whether it is the first run on a tool
        between = None
        for number in range(row.times):
            loops = number // 2 % 2 * BUSY
            with row.fault(f'{kind}, {loops} busy loops'), row.busy(loops):
                if tool and number % 2 == 0:    # the first run on a new tool is a case of its own
                    if between:
                        row.end(between)
                    between = start_tool(row, tool, base)
                check(base, driver, words, ends, tool and number % 2 == 0)
        if between:
            row.end(between)
    base.end()


def start_tool(row, name, base):
    """Start a node of topic_tools, and wait until it listens."""
    base.start()
    tool = row.start('rosrun', 'topic_tools', *TOOLS[name])
    support.wait_for(lambda: any(f'/{name}' in names for topic, names in rospy.get_master().getSystemState()[2][1]
                                 if topic == f'/{name}'), f'the subscription of {name}')
    return tool


def check(base, driver, words, ends, first=False):
    """Run a driver, and compare its end pose with the ends of earlier runs."""
    base.start()
    process = (base.row.start(support.roscpp('early_driver'), *words[1:]) if words[0] == 'roscpp' else
               base.row.start(os.path.join(FOLDER, driver), *words))
    try:
        support.wait_for(lambda: process.process.poll() is not None or not base.runs(), 'the end of the driver')
        assert base.runs(), [line for line in base.launch.lines if 'FATAL' in line]
        assert process.wait() == 0, process.output
    finally:
        process.kill()
    end = repr(support.pose(rospy.wait_for_message('/ground_truth', Odometry, support.LIMIT)))
    expected = ends.setdefault(bool(first), end)
    assert end == expected, f"{end}, in an earlier {'first run' if first else 'run'} {expected}"
    assert not [line for line in base.launch.lines if 'not in step' in line], base.launch.lines
