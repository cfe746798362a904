#!/usr/bin/python3
"""With drivers on simulated time, the robot stops exactly where their sleeps lead on an ideal clock, to a micrometer.

    in_step.py RATE STEP     Hz; step of the clock, s
"""
import os
import sys
import unittest

import rospy
from nav_msgs.msg import Odometry
from std_srvs.srv import Empty

import support

SECOND = 10 ** 9
DRIVER = os.path.join(os.path.dirname(os.path.realpath(__file__)), 'driver_at_rate.py')
SPEED = 0.2     # m/s


class Ideal:
    """Times at which drivers send on a clock that ticks every `step` ns and wakes them at the first tick not before."""

    def __init__(self, step):
        self.step = step

    def tick(self, time):
        """Return the first tick not before a time, ns."""
        return -(-time // self.step)

    def ticks(self, kind, rate, count):
        """Return the ticks of the commands and of the final stop, counted from the first command."""
        if kind == 'sleep':         # each sleep is measured from the tick at which it begins
            return [number * self.tick(round(SECOND / rate)) for number in range(count + 1)]
        period = int(SECOND / rate)     # as in rospy.Rate
        first = 1 if kind == 'timer' else 0     # a Timer's first call is a period after its creation
        ticks = [self.tick((number + first) * period) for number in range(count + 1)]
        return [tick - ticks[0] for tick in ticks]

    def distance(self, *drivers):
        """Return the distance that the robot travels, m. drivers: (speed, ticks) by name order, on the same first
        tick."""
        sent = {}       # by tick: the last command
        for speed, ticks in drivers:
            for tick in ticks[:-1]:
                sent[tick] = speed
            sent[ticks[-1]] = 0.0
        order = sorted(sent)
        return sum(sent[tick] * (after - tick) for tick, after in zip(order, order[1:])) * self.step / SECOND


class TestInStep(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        support.init_node('in_step')
        rospy.wait_for_service('/arbotix/reset')
        cls.rate, step = (float(arg) for arg in sys.argv[1:3])
        cls.count = round(cls.rate)     # number of commands in a second
        cls.ideal = Ideal(round(step * SECOND))

    def start(self, *command):
        """Start a driver, a Process that is killed after the test. Like other drivers, it has the threads of OpenBLAS,
        which script/test switches off."""
        driver = support.Process(*map(str, command), OPENBLAS_NUM_THREADS='')
        self.addCleanup(driver.kill)
        return driver

    def check(self, expected, *drivers):
        """Wait for the drivers to exit, and compare the distance; expected: m."""
        for driver in drivers:
            self.assertEqual(driver.wait(), 0, driver.output)
        # through a new connection, because old messages may be queued in the connection of a busy subscriber
        x = rospy.wait_for_message('/odom', Odometry).pose.pose.position.x
        self.assertAlmostEqual(x, expected, delta=support.MICROMETRE)

    def check_kind(self, kind, *command):
        """Check one driver of this kind, starting at the origin."""
        rospy.ServiceProxy('/arbotix/reset', Empty)()
        driver = self.start(*command)
        self.check(self.ideal.distance((SPEED, self.ideal.ticks(kind, self.rate, self.count))), driver)

    def test_rate(self):
        self.check_kind('rate', DRIVER, 'rate', self.rate, self.count)

    def test_sleep(self):
        self.check_kind('sleep', DRIVER, 'sleep', self.rate, self.count)

    def test_timer(self):
        self.check_kind('timer', DRIVER, 'timer', self.rate, self.count)

    def test_roscpp(self):
        folder = os.path.join(os.environ['CMAKE_PREFIX_PATH'].split(':')[0], 'lib', 'rbx1_nav')
        self.check_kind('rate', os.path.join(folder, 'driver_at_rate'), self.rate, self.count)

    def test_beside_an_idle_driver(self):
        idle = self.start('/usr/bin/python3', '-c', 'import rospy; from geometry_msgs.msg import Twist; '
                          'rospy.init_node("teleop"); p = rospy.Publisher("/cmd_vel", Twist, queue_size=1); '
                          'input("waits for a key\\n")')
        idle.wait_for_line('waits for a key')
        self.test_rate()

    def test_two_drivers(self):
        rospy.ServiceProxy('/arbotix/reset', Empty)()
        drivers = [self.start(DRIVER, 'rate', rate, round(rate), speed, f'__name:={name}')
                   for name, rate, speed in (('a', 20, SPEED), ('b', self.rate, SPEED / 4))]
        for driver in drivers:
            driver.wait_for_line('ready')
        now = rospy.wait_for_message('/odom', Odometry).header.stamp.to_sec()
        for driver in drivers:
            # whole seconds are ticks; at this speed of simulated time, both drivers have read it by then
            driver.type(str(round(now) + 1 + 2 * rospy.get_param('/arbotix/real_time_factor')))
        self.check(self.ideal.distance((SPEED, self.ideal.ticks('rate', 20, 20)),
                                       (SPEED / 4, self.ideal.ticks('rate', self.rate, self.count))), *drivers)


if __name__ == '__main__':
    support.main('in_step', TestInStep)
