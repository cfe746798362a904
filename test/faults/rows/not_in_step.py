"""Drivers that are not on the clock: the base names them."""
import os
import re
import sys

from roslib.packages import get_pkg_dir
import rospy
import yaml

import support

sys.path.append(os.path.join(os.path.dirname(support.__file__), 'base'))
import off_clock

FAULT = ('drivers on wall time, on a keyboard, or from a bag, at real_time_factor 20 with strict; in every second run '
         'beside four busy loops')
PROMISE = 'the base names the driver and exits with status 1'
FULL, SHORT = 20, 2     # runs of each kind of driver
ROOT, ALONE = False, True

BUSY = 4        # loops
KINDS = 'wall_rate', 'wall_thread', 'wait_for_message', 'keys', 'rosbag play', 'rostopic pub'
LIMIT = 30      # s of wall time of a run; the base may also wait for the driver for 5 s
AFTER = 10      # s of wall time after the run in which the base has to exit


def run(row):
    """See FAULT."""
    row.roscore()
    support.init_node('faults')
    with open(os.path.join(get_pkg_dir('rbx1_nav'), 'config/turtlebot.yaml'), encoding='utf-8') as file:
        settings = yaml.safe_load(file)
    rospy.set_param('/use_sim_time', True)
    rospy.set_param('/arbotix', dict(settings, real_time_factor=20, strict=True))
    off_clock.write_commands('commands.bag')
    for kind in KINDS:
        for number in range(row.times):
            loops = number % 2 * BUSY
            with row.fault(f'{kind}, {loops} busy loops'), row.busy(loops):
                check(row, kind)


def check(row, kind):
    """Start a base, and a driver that it has to name."""
    base = row.node('fake_base.py')
    base.wait_for_line('Ready: ')
    driver, name = start(row, kind)
    try:
        support.wait_for(lambda: base.process.poll() is not None or driver.process.poll() is not None,
                         'the end of the driver or the base', LIMIT)
        support.wait_for(lambda: base.process.poll() is not None, 'the exit of the base after the run', AFTER)
        assert base.wait() == 1, f'status {base.wait()}:\n{base.output}'
        assert re.search(f'strict: {name} ', base.output), base.output
    finally:
        row.end(driver, base)


def start(row, kind):
    """Start a driver, and type for it. Returns its Process and a pattern for the name of its node."""
    if kind == 'rosbag play':
        return row.start('rosbag', 'play', 'commands.bag'), r'/play_\d+'
    if kind == 'rostopic pub':
        return row.start('rostopic', 'pub', '-r', '10', '/cmd_vel', 'geometry_msgs/Twist',
                         '{linear: {x: 0.1}}'), r'/rostopic_\w+'
    driver = row.start(off_clock.DRIVER, kind)
    if kind == 'keys':
        off_clock.type_keys(driver)
    return driver, f'/{kind}'
