"""Two hosts joined by a cable: the script on one, base and roscore on the other. The cable is pulled during a leg."""
import contextlib
import os
import subprocess
import time

import support

FAULT = ('script on one host, base and roscore on another; the link goes down during a leg for 0.3 s, for 3 s, or '
         'permanently')
PROMISE = ('0.3 s: exit status 0, or 1 if the base timed out; longer: reported within 2 s, exit status 1, and the '
           'robot keeps moving for at most its timeout of 1 s')
FULL, SHORT = 24, 2
ROOT, ALONE = True, True

HOSTS = ('10.77.0.1', '10.77.0.2')
OUTAGES = (0.3, 3, None)    # s; None: for good
SPEED = 0.2                 # m/s
TIMEOUT = 1.0               # s, of the base
PERIOD = 0.02               # s
NOTICE = 2.0                # s


@contextlib.contextmanager
def two_hosts():
    """Two network namespaces joined by a veth pair; yields their names."""
    names = ['rbx1-%d-%d' % (os.getpid(), number) for number in range(2)]
    cables = ['v%d-%d' % (os.getpid(), number) for number in range(2)]
    try:
        for name in names:
            ip('netns', 'add', name)
            ip('-n', name, 'link', 'set', 'lo', 'up')
        ip('link', 'add', cables[0], 'netns', names[0], 'type', 'veth', 'peer', 'name', cables[1], 'netns', names[1])
        for name, cable, host in zip(names, cables, HOSTS):
            ip('-n', name, 'address', 'add', f'{host}/24', 'dev', cable)
            ip('-n', name, 'link', 'set', cable, 'up')
        yield names, cables
    finally:
        for name in names:
            subprocess.run(['ip', 'netns', 'delete', name], check=False)


def ip(*arguments):
    """Run ip(8)."""
    subprocess.run(('ip',) + arguments, check=True)


def run(row):
    """See FAULT. As docs/installation.md says, each host has the ROS_MASTER_URI of the master, and its own ROS_IP."""
    master = f'http://{HOSTS[0]}:11311'
    with two_hosts() as (names, cables):
        def start(number, *command):
            return row.start('ip', 'netns', 'exec', names[number], *command,
                             ROS_MASTER_URI=master, ROS_IP=HOSTS[number])
        core = start(0, 'roscore')
        core.wait_for_line('started core service')
        launch = start(0, 'roslaunch', 'rbx1_nav', 'fake_turtlebot.launch')
        launch.wait_for_line('Ready: ')
        poses = start(0, 'rostopic', 'echo', '-p', '/odom/pose/pose/position')
        for number in range(row.times):
            outage, delay = OUTAGES[number % 3], row.random.uniform(0.5, 3)
            with row.fault('no link %s after %.2f s' % ('for good' if outage is None else 'for %g s' % outage, delay)):
                try_one(row, lambda: start(
                    1, 'rosrun', 'rbx1_nav', 'timed_out_and_back.py', f'_linear_speed:={SPEED:g}', '_angular_speed:=3',
                    '_goal_distance:=0.8'), poses, names, cables, outage, delay)
            ip('-n', names[0], 'link', 'set', cables[0], 'up')
            # for some seconds the other host may still take this one for unreachable
            support.wait_for(lambda: start(1, 'rosnode', 'list').wait() == 0, 'the link')
        row.end()


def try_one(row, start, poses, names, cables, outage, delay):
    """Drive, and pull the cable."""
    driver = start()
    driver.wait_for_line('Connected to ')
    time.sleep(delay)
    ip('-n', names[0], 'link', 'set', cables[0], 'down')
    pulled, x = time.monotonic(), position(poses)
    if outage is not None and outage < NOTICE:
        time.sleep(outage)
        ip('-n', names[0], 'link', 'set', cables[0], 'up')
        assert driver.wait() == ('no command for 1 s' in driver.output), driver.output
        return
    support.wait_for(lambda: 'Stopping the robot...' in driver.output, f"the script to notice:\n{driver.output}")
    noticed = time.monotonic() - pulled
    row.figure('detected after (s)', noticed)
    time.sleep(max(0, TIMEOUT + 0.5 - noticed))
    way = position(poses) - x
    row.figure('distance without a link (m)', way)
    if outage is not None:
        time.sleep(max(0, pulled + outage - time.monotonic()))
        ip('-n', names[0], 'link', 'set', cables[0], 'up')
    status = driver.wait()
    assert status == 1 and '/arbotix' in driver.output and 'Traceback' not in driver.output, driver.output
    assert noticed <= NOTICE, f'detected after {noticed:.2f} s'
    # a command may be on its way, and the last line of odometry be a period old
    assert way <= SPEED * (TIMEOUT + 3 * PERIOD), f'the robot kept moving for {way:.3f} m'


def position(poses):
    """x of the last line of `rostopic echo -p`, m."""
    return float(poses.lines[-1].split(',')[1])
