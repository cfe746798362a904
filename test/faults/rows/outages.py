"""A sender on one host, a base on the other: the link goes down, and the sender dies meanwhile, or lives."""
import os
import signal
import time

import support
from rows.two_hosts import HOSTS, ip, position, two_hosts

FAULT = ('a sender at 10, 20 or 50 Hz on one host, a simulated base or the base of an emulated Create on another; the '
         'link goes down for 1 to 10 s; in every second fault, the sender is killed meanwhile')
PROMISE = ('killed: the robot moves by at most 5 mm after the link is up, if at least four commands were sent in the '
           'outage; otherwise, it drives on within 1 s after the first of its commands has arrived')
FULL, SHORT = 24, 2
ROOT, ALONE = True, True

TWIST = '{linear: {x: 0.2}}'
RATES = (10, 20, 50)
WATCH = 16      # s in which TCP repeats lost data at the latest, after an outage of 10 s


def wait_for_standstill(poses):
    """Return x (m) of a robot at rest."""
    def stands():
        before = position(poses)
        time.sleep(0.5)
        return position(poses) == before
    support.wait_for(stands, 'a standstill')
    return position(poses)


def try_one(row, start, poses, names, cables, rate, outage, dies):
    """Drive, take the link down, and watch what happens when it is up."""
    begin = position(poses)
    sender = start(1, 'rostopic', 'pub', '-r', str(rate), '/cmd_vel', 'geometry_msgs/Twist', TWIST)
    support.wait_for(lambda: position(poses) > begin + 0.3, 'the robot to move')
    ip('-n', names[0], 'link', 'set', cables[0], 'down')
    down = time.monotonic()
    time.sleep(outage * (0.7 if dies else 1))
    if dies:
        os.killpg(sender.process.pid, signal.SIGKILL)
        time.sleep(max(0, down + outage - time.monotonic()))
    x = position(poses)
    ip('-n', names[0], 'link', 'set', cables[0], 'up')
    if dies:
        if outage > 1.5:
            time.sleep(WATCH if outage > 3 else WATCH / 2)
            row.figure('killed: travel (m)', wait_for_standstill(poses) - x)
            assert position(poses) - x <= 0.005, f'{position(poses) - x:.3f} m'
        return
    support.wait_for(lambda: position(poses) > x + 0.001, 'the robot to move', 2 * WATCH)
    time.sleep(1)
    x = position(poses)
    time.sleep(1)
    row.figure('alive: speed a second after the first command (m/s)', position(poses) - x)
    assert position(poses) - x > 0.15, f'{position(poses) - x:.3f} m in a second'
    sender.kill()
    wait_for_standstill(poses)


def run(row):
    """See FAULT."""
    master = f'http://{HOSTS[0]}:11311'
    for launch in ('rbx1_nav', 'fake_turtlebot.launch'), ('rbx1_bringup', 'fake_turtlebot_create.launch'):
        with two_hosts() as (names, cables):
            def start(number, *command, name=names):
                return row.start('ip', 'netns', 'exec', name[number], *command, ROS_MASTER_URI=master,
                                 ROS_IP=HOSTS[number])
            start(0, 'roscore').wait_for_line('started core service')
            start(0, 'roslaunch', *launch).wait_for_line('Ready: |in safe mode')
            poses = start(0, 'rostopic', 'echo', '-p', '/odom/pose/pose/position')
            support.wait_for(lambda: len(poses.lines) > 5, '/odom')
            for number in range(row.times // 2):
                rate, outage, dies = RATES[number // 2 % 3], row.random.uniform(1, 10), number % 2 == 0
                with row.fault('%s: %d Hz, no link for %.1f s, the sender %s' % (
                        launch[1], rate, outage, 'dies' if dies else 'lives')):
                    try_one(row, start, poses, names, cables, rate, outage, dies)
                support.wait_for(lambda: start(1, 'rosnode', 'list').wait() == 0, 'the link')
            row.end()
