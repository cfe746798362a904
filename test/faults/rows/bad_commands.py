"""Commands that no driver should send: the base keeps running, reports finite values, then obeys normal commands."""
import itertools
import math
import os
import time

from geometry_msgs.msg import Twist

import support

FAULT = ('Twists with NaN, infinities, 1e308, denormals, lateral and vertical components; random Twists; 5,000 Twists '
         'per second for 10 s')
PROMISE = ('/odom stays finite, and the base obeys exactly afterwards; its memory does not grow, and it logs at most 2 '
           'lines per second')
FULL, SHORT = 10000, 500       # random Twists
ROOT = ALONE = False

FIELDS = list(itertools.product(('linear', 'angular'), 'xyz'))
VALUES = (math.nan, math.inf, -math.inf, 1e308, -1e308, 5e-324, -5e-324, 1.0, -0.0)
FLOOD = 5000            # commands a second
LAST = 0.123            # m/s, a command that nothing else here sends
LINES = 2               # a second
MEMORY_LIMIT = 4096     # KB


def run(row):
    """See FAULT."""
    row.roscore()
    # simulated time, so that a run ends exactly; hardly faster than real time, because the base limits its lines on it
    base = row.base('real_time_factor:=1.01')
    support.init_node('faults')
    odom = support.OdomWatch()
    pid = support.pid_of('/arbotix')
    seconds = 10 * row.times / FULL
    for text, fault in (('each value in each field', each_value), ('random Twists', random_twists),
                        ('%d a second for %g s' % (FLOOD, seconds), flood)):
        with row.fault(text):
            commander = support.Commander()
            for _ in range(150):    # more than a second without a pause: now commands take effect as they arrive
                commander.send(LAST)
                time.sleep(0.01)
            odom.wait_for_twist(LAST)
            start, lines, memory = time.monotonic(), len(base.lines), rss(pid)
            fault(row, commander, odom)
            for speed in (LAST, 0.0):       # the base has them in a queue: until it has come to the last
                commander.send(speed)
                odom.wait_for_twist(speed)
            limit = LINES * (time.monotonic() - start) + 3      # and one of each kind at once
            assert len(base.lines) - lines <= limit, '\n'.join(base.lines[lines:])
            row.figure('memory growth (KB)', rss(pid) - memory)
            assert rss(pid) <= memory + MEMORY_LIMIT, 'the memory has grown by %d KB' % (rss(pid) - memory)
            for message in odom.messages:
                values = numbers(message)
                assert all(map(math.isfinite, values)), f'non-finite odometry: {values[:7]}'
            del odom.messages[:-1]
            commander.publisher.unregister()
            row.reset()
            if row.times >= FULL or fault is flood:     # it takes 8 s
                check_obeys(row, odom)


def check_obeys(row, odom):
    """A run of 0.1 m and 0.5 rad each ends exactly."""
    driver = row.node('timed_out_and_back.py', '_goal_distance:=0.1', '_goal_angle:=0.5')
    assert driver.wait() == 0, driver.output
    x, y, yaw = support.pose(odom.next())
    off = math.hypot(x - 0.1 - 0.1 * math.cos(0.5), y - 0.1 * math.sin(0.5))
    assert off < support.MICROMETRE and abs(yaw - 1) < 1e-6, f'{off:g} m and {yaw - 1:g} rad off'


def each_value(row, commander, odom):
    """Every special value in every field of a Twist, after an ordinary motion."""
    for (part, axis), value in itertools.product(FIELDS, VALUES):
        message = support.twist(0.2, 0.5)
        setattr(getattr(message, part), axis, value)
        commander.publisher.publish(message)
        row.faults += 1
        if not abs(value) < 1e6:    # rejected, whatever the field
            odom.wait_for_twist(0.0)
        time.sleep(0.01)


def random_twists(row, commander, *_):
    """Twists of numbers of all magnitudes."""
    for _ in range(row.times):
        message = Twist()
        for part, axis in FIELDS:
            value = row.random.choice((0.0, row.random.uniform(-1, 1), row.random.choice(VALUES),
                                       row.random.choice((-1, 1)) * 10 ** row.random.uniform(-320, 308)))
            setattr(getattr(message, part), axis, value)
        commander.publisher.publish(message)
        row.faults += 1
        time.sleep(0.001)


def flood(row, commander, *_):
    """More commands than any driver sends."""
    start = time.monotonic()
    for count in range(round(FLOOD * 10 * row.times / FULL)):
        commander.send(0.2 if count % 2 else -0.2)
        time.sleep(max(0, start + count / FLOOD - time.monotonic()))
    row.figure('commands per second in the flood', (count + 1) / (time.monotonic() - start))


def numbers(message):
    """All numbers of an Odometry."""
    pose, speed = message.pose.pose, message.twist.twist
    parts = pose.position, pose.orientation, speed.linear, speed.angular
    return [getattr(part, axis) for part in parts for axis in 'xyz'] + [
        pose.orientation.w, *message.pose.covariance, *message.twist.covariance]


def rss(pid):
    """The memory of a process, KB."""
    with open('/proc/%d/statm' % pid, encoding='utf-8') as file:
        return int(file.read().split()[1]) * os.sysconf('SC_PAGE_SIZE') // 1024
