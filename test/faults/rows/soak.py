"""An hour of simulated time out and back: nothing grows, and the odometry is exact."""
import math
import os
import time

import rospy
from nav_msgs.msg import Odometry

import support

FAULT = 'minutes of simulated time, driving out and back repeatedly, at up to 30 times real time'
PROMISE = ('memory, threads and file descriptors of the base do not grow; /odom is within 1 mm and 1 mrad of the '
           'exact integral')
FULL, SHORT = 60, 28     # minutes; fewer are too short for eight drives
ROOT = ALONE = False

WARM_UP = 4         # runs: later, nothing connects for the first time
GROWTH = 4096       # kB: over 160 drives, what the allocator keeps varied by 3 MB and did not grow
DISTANCE, TURN = 10.0, 3.14     # m and rad of a motion: whole ticks


def usage(pid):
    """(resident memory in kB, threads, file descriptors) of a process."""
    with open('/proc/%d/status' % pid, encoding='ascii') as file:
        status = dict(line.split(':', 1) for line in file)
    return int(status['VmRSS'].split()[0]), int(status['Threads']), len(os.listdir('/proc/%d/fd' % pid))


def after_run(pose):
    """(x, y, heading) after one more run: out and back by DISTANCE and TURN."""
    x, y, heading = pose
    for _ in range(2):
        x, y = x + DISTANCE * math.cos(heading), y + DISTANCE * math.sin(heading)
        heading += TURN
    return x, y, heading


def run(row):
    """See FAULT."""
    row.roscore()
    row.base('real_time_factor:=30')
    support.init_node('faults')
    pid = support.pid_of('/arbotix')
    pose, usages = (0.0, 0.0, 0.0), []
    first = rospy.wait_for_message('/odom', Odometry).header.stamp.to_sec()
    elapsed = 0
    while elapsed < 60 * row.times:
        with row.fault(f'{elapsed / 60:.0f} minutes'):
            driver = row.start('rosrun', 'rbx1_nav', 'timed_out_and_back.py', f'_goal_distance:={DISTANCE:g}',
                               f'_goal_angle:={TURN:g}')
            assert driver.wait() == 0, driver.output
            pose = after_run(pose)
            odom = rospy.wait_for_message('/odom', Odometry)
            x, y, heading = support.pose(odom)
            away, turned = math.hypot(x - pose[0], y - pose[1]), abs(support.wrapped(heading - pose[2]))
            row.figure('distance from the exact pose (m)', away)
            row.figure('deviation from the exact heading (rad)', turned)
            assert away < 1e-3 and turned < 1e-3, f'{away:.6f} m and {turned:.6f} rad from the exact pose'
        elapsed = odom.header.stamp.to_sec() - first
        samples = []
        for _ in range(20):     # 2 s for the connections to end
            time.sleep(0.1)
            samples.append(usage(pid))
        usages.append([min(column) for column in zip(*samples)])
    row.figure('simulated hours', elapsed / 3600)
    with row.fault('growth'):
        assert len(usages) >= WARM_UP + 4, f'only {len(usages)} runs in this time'
        early, late = usages[WARM_UP:WARM_UP + 2], usages[-2:]
        row.figure('memory after warm-up and at the end (MB)', min(u[0] for u in early) / 1024)
        row.figure('memory after warm-up and at the end (MB)', min(u[0] for u in late) / 1024)
        growth = [min(column) - min(before) for column, before in zip(zip(*late), zip(*early))]
        assert growth[0] <= GROWTH and growth[1] <= 0 and growth[2] <= 0, \
            'growth by %d kB, %d threads, %d file descriptors: %s' % (*growth, usages)
    row.faults = row.times
