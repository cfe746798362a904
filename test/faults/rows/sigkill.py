"""SIGKILL to the driving script: the base stops by itself."""
import math

import support

FAULT = 'SIGKILL to the script at a random moment of a motion'
PROMISE = 'the robot keeps moving for at most the timeout of 1 s plus one period'
FULL, SHORT = 40, 2
ROOT = ALONE = False

TIMEOUT, PERIOD, SPEED = 1.0, 0.02, 0.2     # s, s, m/s


def run(row):
    """See FAULT."""
    row.roscore()
    row.base('real_time_factor:=5')
    support.init_node('faults')
    odom = support.OdomWatch()
    for _ in range(row.times):
        moment = row.random.uniform(0, 2)
        with row.fault(f'SIGKILL {moment:.3f} s of simulated time after the start of the motion'):
            driver = row.start('rosrun', 'rbx1_nav', 'timed_out_and_back.py')
            start = odom.wait_for_twist(SPEED).header.stamp
            support.wait_for(lambda: (odom.last.header.stamp - start).to_sec() >= moment, 'the moment')
            driver.kill()
            killed = odom.position()
            odom.wait_for_twist(0.0)
            way = math.dist(killed, odom.position())
            row.figure('distance after SIGKILL (m)', way)
            # odometry that was under way when it was killed may be a period old
            assert way <= SPEED * (TIMEOUT + 2 * PERIOD), f'the robot kept moving for {way:.4f} m'
