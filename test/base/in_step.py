#!/usr/bin/python3
"""With drivers on simulated time, the robot stops exactly where their sleeps lead on an ideal clock, to a micrometer.

    in_step.py STEP RATE...     step of the clock, s; Hz
"""
from math import cos, pi, sin
import os
import sys

import rospy
from nav_msgs.msg import Odometry
from std_srvs.srv import Empty

import support

SECOND = 10 ** 9
DRIVER = os.path.join(os.path.dirname(os.path.realpath(__file__)), 'driver_at_rate.py')
SPEED = 0.2     # m/s
RATES = [int(arg) for arg in sys.argv[2:] if arg.isdigit()]
# rates (Hz) at which processes of their own are started: whole and odd numbers of ticks, and one command in each tick
PROCESSES = {7, 20, 33, 50, 100}


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
        period = round(SECOND / rate) if kind == 'roscpp' else int(SECOND / rate)       # as in ros::Rate, rospy.Rate
        first = 1 if kind == 'timer' else 0     # a Timer's first call is a period after its creation
        ticks = [self.tick((number + first) * period) for number in range(count + 1)]
        return [tick - ticks[0] for tick in ticks]

    def exercise(self, rate):
        """Return the x and y (m) at which timed_out_and_back.py stops."""
        length, angle = (self.ticks('rate', rate, int(seconds * rate))[-1] * self.step / SECOND for seconds in (5, pi))
        return SPEED * length * (1 + cos(angle)), SPEED * length * sin(angle)

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


class TestInStep(support.Case):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        rospy.wait_for_service('/arbotix/reset')
        cls.ideal = Ideal(round(float(sys.argv[1]) * SECOND))

    def start(self, *command):
        """Start a driver, a Process that is killed after the test. Like other drivers, it has the threads of OpenBLAS,
        which script/test switches off."""
        return support.Process(*map(str, command), OPENBLAS_NUM_THREADS='')

    def travel(self):
        """Return the x of the robot, m."""
        # through a new connection, because old messages may be queued in the connection of a busy subscriber
        return rospy.wait_for_message('/odom', Odometry).pose.pose.position.x

    def check_kind(self, kind, *command):
        """Check one driver of this kind, which drives for a second at each rate."""
        rospy.ServiceProxy('/arbotix/reset', Empty)()
        driver = self.start(*command, ','.join(map(str, RATES)))
        before = 0.0
        for number, rate in enumerate(RATES, 1):
            support.wait_for(lambda: driver.output.count('rests') == number or driver.process.poll() is not None,
                             f'the end at {rate} Hz')
            x = self.travel()
            self.assertAlmostEqual(x - before, self.ideal.distance((SPEED, self.ideal.ticks(kind, rate, rate))),
                                   delta=support.MICROMETRE, msg=f'{rate} Hz')
            if number < len(RATES):
                driver.type('')
            before = x
        self.assertEqual(driver.wait(), 0, driver.output)

    def test_rate(self):
        self.check_kind('rate', DRIVER, 'rate')

    def test_sleep(self):
        self.check_kind('sleep', DRIVER, 'sleep')

    def test_timer(self):
        self.check_kind('timer', DRIVER, 'timer')

    def test_roscpp(self):
        self.check_kind('roscpp', support.roscpp('driver_at_rate'))

    def test_beside_an_idle_driver(self):
        idle = self.start('/usr/bin/python3', '-c', 'import rospy; from geometry_msgs.msg import Twist; '
                          'rospy.init_node("teleop"); p = rospy.Publisher("/cmd_vel", Twist, queue_size=1); '
                          'input("waits for a key\\n")')
        idle.wait_for_line('waits for a key')
        self.test_rate()
        idle.type('')
        idle.wait()     # unregisters: otherwise the base would try to connect to whoever has this port next

    def test_script(self):
        """The package's own script."""
        for rate in PROCESSES.intersection(RATES):
            rospy.ServiceProxy('/arbotix/reset', Empty)()
            driver = support.out_and_back(f'_rate:={rate}')
            self.assertEqual(driver.wait(), 0, driver.output)
            x, y, _ = support.pose(rospy.wait_for_message('/odom', Odometry))
            for value, ideal in zip((x, y), self.ideal.exercise(rate)):
                self.assertAlmostEqual(value, ideal, delta=support.MICROMETRE, msg=f'{rate} Hz')

    def test_two_drivers(self):
        for rate in PROCESSES.intersection(RATES):
            rospy.ServiceProxy('/arbotix/reset', Empty)()
            drivers = [self.start(DRIVER, 'rate', each, speed, f'__name:={name}')
                       for name, each, speed in (('a', 20, SPEED), ('b', rate, SPEED / 4))]
            for driver in drivers:
                driver.wait_for_line('ready')
            now = rospy.wait_for_message('/odom', Odometry).header.stamp.to_sec()
            for driver in drivers:
                # whole seconds are ticks; at this speed of simulated time, both drivers have read it by then
                driver.type(str(round(now) + 1 + 2 * rospy.get_param('/arbotix/real_time_factor')))
            for driver in drivers:
                self.assertEqual(driver.wait(), 0, driver.output)
            expected = self.ideal.distance((SPEED, self.ideal.ticks('rate', 20, 20)),
                                           (SPEED / 4, self.ideal.ticks('rate', rate, rate)))
            self.assertAlmostEqual(self.travel(), expected, delta=support.MICROMETRE, msg=f'{rate} Hz')


if __name__ == '__main__':
    support.main(TestInStep)
