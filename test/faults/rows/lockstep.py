"""The exercise in lockstep on a busy machine: three masters side by side, a busy loop beside each."""
import json
import os
import random
import signal
import sys
import time

FOLDER = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
sys.path[:0] = [FOLDER, os.path.dirname(FOLDER)]    # as a station, this is a program of its own

import rospy
from nav_msgs.msg import Odometry

from ports import free_port
from row import Row
import support

FAULT = ('the exercise at real_time_factor 20 with strict, on three masters side by side with a busy loop each; in a '
         'quarter of the runs, the script or the base is suspended for 10 to 500 ms')
PROMISE = 'the exact end pose, to within a micrometer; no driver is named'
FULL, SHORT = 200, 3
ROOT, ALONE = False, True

STATIONS = 3
FACTOR = 20


def run(row):
    """See FAULT. Each station is a process of its own, with a master of its own."""
    seeds = [row.random.randrange(10 ** 6) for _ in range(STATIONS)]
    counts = [len(range(number, row.times, STATIONS)) for number in range(STATIONS)]
    stations = []
    for seed, count in zip(seeds, counts):
        master = 'http://127.0.0.1:%d' % free_port()
        row.start('/usr/bin/python3', '-c', 'while True: pass')
        stations.append(row.start('/usr/bin/python3', __file__, str(seed), str(count), ROS_MASTER_URI=master))
    for station in stations:
        station.process.wait()
        station.reader.join(5)
        results = [json.loads(line[1:]) for line in station.lines if line.startswith('=')]
        for text, trouble in results:
            with row.fault(text):
                assert not trouble, trouble
        assert len(results) == counts[stations.index(station)], station.output


def station(seed, count):
    """Drive so many times; prints what was done, and what was wrong, as one line each."""
    generator = random.Random(seed)
    row = Row('station', count, seed)
    row.roscore()
    launch = row.base('real_time_factor:=%d' % FACTOR, 'strict:=true')
    support.init_node('faults')
    base = support.pid_of('/arbotix')
    for number in range(count):
        row.reset()
        driver = row.node('timed_out_and_back.py')
        text = 'run %d of the station with seed %d' % (number, seed)
        if number % 4 == 0:
            who, delay, length = (generator.choice(('script', 'base')),
                                  generator.uniform(0, 3), generator.uniform(0.01, 0.5))
            text += f', {who} suspended after {delay:.2f} s for {1000 * length:.0f} ms'
            time.sleep(delay)
            suspend(driver.process.pid if who == 'script' else base, length)
        driver.process.wait()
        driver.reader.join(5)
        # by a new connection: in that of a busy subscriber, old messages may wait
        x, y, yaw = support.pose(rospy.wait_for_message('/odom', Odometry))
        error = max(abs(x - support.EXACT_X), abs(y - support.EXACT_Y), abs(support.wrapped(yaw - support.EXACT_TURN)))
        trouble = '' if error < support.MICROMETRE and driver.process.returncode == 0 else \
            'status %d, %g m or rad off\n%s\n%s' % (
                driver.process.returncode, error, driver.output, '\n'.join(launch.lines[-5:]))
        print(f'={json.dumps([text, trouble])}', flush=True)
    row.end()
    os._exit(0)


def suspend(pid, length):
    """Suspend a process for a while."""
    try:
        os.kill(pid, signal.SIGSTOP)
        time.sleep(length)
        os.kill(pid, signal.SIGCONT)
    except ProcessLookupError:      # it has ended
        pass


if __name__ == '__main__':
    station(int(sys.argv[1]), int(sys.argv[2]))
