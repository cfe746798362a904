"""Stop and driving by hand while other drivers come and go, and Stop while the node is frozen."""
import os
import re
import signal
import sys
import time

import rospy

import support
from rows.browsers import SPEED, TIMEOUT, View
from web_client import WebClient

FAULT = ('a driver unregisters 0 to 30 ms before or after a Stop; a run of the page is stopped at a random moment; the '
         'node is frozen when a Stop arrives; another driver, the base or the master is frozen just before it')
PROMISE = ('the Stop is answered; the robot is at rest; hand driving works afterwards; a frozen node answers when it '
           'runs again; the answer names the driver or master that is frozen, or that no odometry has arrived; when '
           'these run again, the robot moves for at most the timeout of the base, 1 s')
FULL, SHORT = 96, 8
ROOT, ALONE = False, True

MARGIN = 0.03       # s
REST = 2.0          # s: longer than the timeout of the base
DRIVER = '''
import sys, rospy
from geometry_msgs.msg import Twist
rospy.init_node('driver', anonymous=True)
publisher = rospy.Publisher('/cmd_vel', Twist, queue_size=5)
command = Twist()
command.linear.x = 0.2
timer = rospy.Timer(rospy.Duration(0.05), lambda event: publisher.publish(command))
sys.stdin.readline()
timer.shutdown()
publisher.publish(Twist())
publisher.unregister()
sys.stdin.readline()
'''


def answer(client):
    """Wait for the answer to Stop; return the time until then, s."""
    start = time.monotonic()
    stopped = client.wait_for('stopped')
    assert stopped['stationary'], stopped
    return time.monotonic() - start


def other_driver(row, view):
    """Start another driver; return its Process when the robot moves."""
    count = len(view.odom.messages)
    driver = row.start(sys.executable, '-c', DRIVER)
    # until then, its commands are mixed with the zeros of the view, which go on for 1 s after driving by hand
    view.odom.wait_for_twist(0.2, since=count)
    return driver


def leaving_driver(row, view, client):
    """Another driver unregisters just before or after a Stop."""
    driver = other_driver(row, view)
    delay = row.random.uniform(-MARGIN, MARGIN)
    if delay < 0:
        driver.type('')
    time.sleep(abs(delay) / 2)
    client.send(type='stop', number=1)
    time.sleep(abs(delay) / 2)
    if delay >= 0:
        driver.type('')
    answer(client)
    driver.process.stdin.close()
    driver.wait()       # with an error if it was shut down while it published


def run_of_the_page(row, view, client):
    """A run of the page is stopped at a random moment."""
    client.send(type='run', method='timed')
    time.sleep(row.random.uniform(0, 4))
    client.send(type='stop', number=1)
    row.figure('answer to Stop during a run, s', answer(client))


def frozen(row, view, client):
    """The node is frozen when a Stop arrives, and runs again later."""
    client.send(type='run', method='timed')
    support.wait_for(lambda: view.odom.last.twist.twist.linear.x, 'the run')
    time.sleep(row.random.uniform(0, 0.5))
    view.process.signal(signal.SIGSTOP)
    client.send(type='stop', number=1)
    time.sleep(row.random.uniform(0.1, 1.5))
    view.process.signal(signal.SIGCONT)
    row.figure('answer to Stop after the node was frozen, s', answer(client))


def stop_beside_frozen(row, view, client, pid, what):
    """Freeze a process and stop the robot; the process runs again after the answer. Returns the answer."""
    os.kill(pid, signal.SIGSTOP)
    start = time.monotonic()
    try:
        client.send(type='stop', number=1)
        stopped = client.wait_for('stopped')
        row.figure(f'answer to Stop beside a frozen {what}, s', time.monotonic() - start)
        before = view.odom.position()[0]
    finally:
        os.kill(pid, signal.SIGCONT)
    time.sleep(REST)
    travel = view.odom.position()[0] - before
    row.figure(f'travel after a frozen {what} runs again, m', travel)
    assert travel < SPEED * (TIMEOUT + 0.2), f'{travel:.3f} m'    # 0.2 s: first command, last odometry
    return stopped


def frozen_driver(row, view, client):
    """Another driver is frozen."""
    driver = other_driver(row, view)
    stopped = stop_beside_frozen(row, view, client, driver.process.pid, 'driver')
    assert stopped['stationary'] and '/driver' in ''.join(stopped['silent']), stopped
    driver.process.stdin.close()
    driver.wait()


def frozen_base(row, view, client):
    """The base is frozen while another driver drives it."""
    driver = other_driver(row, view)
    stopped = stop_beside_frozen(row, view, client, support.pid_of('/arbotix'), 'base')
    assert not stopped['stationary'] and 'no odometry' in stopped['text'], stopped
    driver.process.stdin.close()
    driver.wait()


def frozen_master(row, view, client):
    """The master is frozen while another driver drives."""
    driver = other_driver(row, view)
    stopped = stop_beside_frozen(row, view, client, rospy.get_master().getPid()[2], 'master')
    assert 'the master' in stopped['silent'] and '/driver' in ''.join(stopped['silent']), stopped
    driver.process.stdin.close()
    driver.wait()


def drives(view, client):
    """Assert that driving by hand works."""
    client.send(type='hand', on=True)
    start = time.monotonic()
    while view.odom.last.twist.twist.linear.x != 0.2:
        client.send(type='drive', forward=1.0)
        time.sleep(0.05)
        assert time.monotonic() - start < support.LIMIT / 10, 'hand driving does not work'
    client.send(type='hand', on=False)
    view.odom.wait_for_twist(0.0)


KINDS = [leaving_driver, run_of_the_page, leaving_driver, run_of_the_page, frozen, frozen_driver, frozen_base,
         frozen_master]


def run(row):
    """See FAULT."""
    row.roscore()
    row.base('model:=none')
    support.init_node('faults')
    view = View(row)
    for number in range(row.times):
        kind = KINDS[number % len(KINDS)]
        with row.fault(f'{kind.__name__} ({number})'):
            client = WebClient(view.port, view.token)
            client.wait_for('welcome')
            kind(row, view, client)
            view.odom.wait_for_twist(0.0)
            drives(view, client)
            client.close()
            lines = re.findall('.*is not a publisher of.*', view.process.output)
            assert not lines, lines
