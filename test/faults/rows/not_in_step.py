"""Drivers that are not on the clock: the base names them."""
import os
import re
import time

import rosbag
import rospy

from rbx1_nav.node import resources
from rbx1_nav.node.config import load_yaml
import support

FAULT = ('drivers on wall time, on a keyboard, or from a bag, at real_time_factor 20 with strict; in every second run '
         'beside four busy loops')
PROMISE = 'the base names the driver and exits with status 1'
FULL, SHORT = 20, 2     # runs of each kind of driver
ROOT, ALONE = False, True

DRIVER = os.path.join(os.path.dirname(support.__file__), 'base', 'off_clock_driver.py')
BUSY = 4        # loops
PAUSES = 0.1, 0.4, 0.2, 0.3, 0.1    # s between two keys
KINDS = 'wall_rate', 'wall_thread', 'wait_for_message', 'keys', 'rosbag play', 'rostopic pub'
LIMIT = 30      # s of wall time of a run; the base may also wait for the driver for 5 s
AFTER = 10      # s of wall time after the run in which the base has to exit


def run(row):
    """See FAULT."""
    row.roscore()
    support.init_node('faults')
    settings = load_yaml(resources.path('config', 'turtlebot.yaml'))
    rospy.set_param('/use_sim_time', True)
    rospy.set_param('/arbotix', dict(settings, real_time_factor=20, strict=True))
    write_commands('commands.bag')
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
    driver = row.start(DRIVER, kind)
    if kind == 'keys':
        type_keys(driver)
    return driver, f'/{kind}'


def type_keys(driver):
    """Type for the kind keys."""
    driver.wait_for_line('waits for a key')
    for pause in PAUSES:
        driver.type('0.1')
        time.sleep(pause)
    driver.process.stdin.close()


def write_commands(path):
    """Write a bag with commands at 10 Hz, of which the last one is the stop."""
    with rosbag.Bag(path, 'w') as bag:
        for number in range(21):
            bag.write('/cmd_vel', support.twist(0.1 if number < 20 else 0.0), rospy.Time(1 + number / 10))
