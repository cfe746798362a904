"""Time that jumps and stands still: the system clock of one node, and simulated time of all nodes."""
import os
import threading
import time

import rospkg
import rospy
from rosgraph_msgs.msg import Clock

PACKAGE = rospkg.RosPack().get_path('rbx1_nav')
PERIOD = 0.02       # s, of /clock
# the node itself, with a time of day that is off by the number in a file
STEPPED = """
import runpy, sys, time
real, (node, offset) = time.time, sys.argv[1:3]
time.time = lambda: real() + float(open(offset).read() or 0)
time.time_ns = lambda: int(time.time() * 1e9)
sys.argv[:3] = [node]
runpy.run_path(node, run_name='__main__')
"""


class Time:
    """What all nodes see of time: simulated, if `simulated`, 4 times as fast as real time; and steps of one node."""

    def __init__(self, row, simulated):
        self.row = row
        rospy.set_param('/use_sim_time', simulated)
        self.now, self.stands, self.done = 1e6, False, threading.Event()
        self.publisher = rospy.Publisher('/clock', Clock, queue_size=10)
        if simulated:
            threading.Thread(target=self.run, daemon=True).start()
        self.step(0)

    def run(self):
        """Publish /clock."""
        while not self.done.wait(PERIOD / 4):
            self.now += 0 if self.stands else PERIOD
            self.publisher.publish(rospy.Time.from_sec(self.now))

    def step(self, seconds):
        """Step the system clock of the node that start() starts."""
        with open('offset.new', 'w', encoding='ascii') as file:
            file.write('%+d' % seconds)
        os.rename('offset.new', 'offset')

    def start(self, node, *arguments):
        """Start a node whose system clock can be stepped."""
        return self.row.start('/usr/bin/python3', '-c', STEPPED, f'{PACKAGE}/nodes/{node}', 'offset', *arguments)

    def disturb(self):
        """One random disturbance."""
        self.row.random.choice([self.leap, self.leap, self.stand])()

    def leap(self):
        """Jump by up to an hour, either way."""
        self.now += self.row.random.choice([-1, 1]) * 10 ** self.row.random.uniform(0, 3.5)

    def stand(self):
        """Stand still for 2 s of wall time."""
        self.stands = True
        time.sleep(2)
        self.stands = False
