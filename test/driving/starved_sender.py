#!/usr/bin/python3
"""If the thread that sends commands starves, or the script is suspended, no command is lost in lockstep unnoticed."""
import signal
import time

import rospkg
import rospy
from geometry_msgs.msg import Twist
from rosgraph_msgs.msg import Log

import support

NODE = f"{rospkg.RosPack().get_path('rbx1_nav')}/nodes/timed_out_and_back.py"
# The unchanged script; each command to the node `peer` is delayed by a number of seconds. On a busy machine, a thread
# does not sleep during the delay but waits for CPU time; with a recorder that reads slowly, it sleeps.
STARVED = """
import runpy, sys, time
from rospy.impl.tcpros_base import TCPROSTransport
send, (node, peer, delay, busy) = TCPROSTransport.write_data, sys.argv[1:]
def write_data(self, data):
    if (self.name, self.endpoint_id) == ('/cmd_vel', peer):
        end = time.monotonic() + float(delay)
        while time.monotonic() < end:
            if busy != 'busy':
                time.sleep(float(delay))
    return send(self, data)
TCPROSTransport.write_data = write_data
sys.argv = [node, '_goal_distance:=0.1']
runpy.run_path(node, run_name='__main__')
"""

# The script itself, which stops its own process with the tenth command.
SUSPENDED = """
import os, runpy, signal, sys
import rospy
publish, count = rospy.Publisher.publish, 0
def stop_at_the_tenth(self, *args):
    global count
    publish(self, *args)
    count += self.name == '/cmd_vel'
    if self.name == '/cmd_vel' and count == 10:
        os.kill(os.getpid(), signal.SIGSTOP)
rospy.Publisher.publish = stop_at_the_tenth
sys.argv = sys.argv[1:]
runpy.run_path(sys.argv[0], run_name='__main__')
"""


class TestStarvedSender(support.Case):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.odom = support.OdomWatch()
        cls.log = support.Watch('/rosout', Log)

    def drive(self, peer, delay, busy=True):
        """Run the exercise; return the Process when it has exited."""
        driver = support.Process('/usr/bin/python3', '-c', STARVED, NODE, peer, str(delay),
                                 'busy' if busy else 'asleep')
        driver.wait()
        self.assertNotIn('Traceback', driver.output)
        return driver

    def report(self, driver):
        """Return the output of a driver, and the warnings of all nodes, such as of a base that released it."""
        return [driver.output, *(each.msg for each in self.log.messages if each.level >= Log.WARN)]

    def check_end(self, driver, before):
        """Check that the exit status is 0 and that the robot has turned by the exact angle; before: heading, rad."""
        self.assertEqual(driver.process.returncode, 0, self.report(driver))
        turn = support.wrapped(support.yaw(self.odom.next()) - before - support.EXACT_TURN)
        self.assertAlmostEqual(turn, 0, delta=1e-6)     # much less than the 0.02 rad of one command

    def test_to_the_base(self):
        before = support.yaw(self.odom.next())
        driver = self.drive('/arbotix', 0.01)
        self.check_end(driver, before)
        self.assertNotIn('lost', driver.output)

    def test_to_the_base_for_too_long(self):
        driver = self.drive('/arbotix', 3, busy=False)
        self.assertEqual(driver.process.returncode, 1, driver.output)
        self.assertRegex(driver.output, r'/cmd_vel: \d+ of 369 commands to /arbotix were lost')

    def test_to_another_listener(self):
        recorder = support.Watch('/cmd_vel', Twist)
        self.addCleanup(recorder.subscriber.unregister)
        before = support.yaw(self.odom.next())
        driver = self.drive(rospy.get_name(), 0.2, busy=False)
        self.check_end(driver, before)
        self.assertRegex(driver.output, r'\[WARN\].*: /cmd_vel: \d+ of 369 commands to /starved_sender\S* were lost')

    def test_suspended(self):
        driver = support.Process('/usr/bin/python3', '-c', SUSPENDED, NODE)
        with open(f'/proc/{driver.process.pid}/stat') as stat:
            support.wait_for(lambda: (stat.seek(0), stat.read().rpartition(')')[2].split()[0])[1] == 'T',
                             'a script that is suspended', 60)
        time.sleep(6)
        driver.process.send_signal(signal.SIGCONT)
        driver.wait()
        self.assertEqual(driver.process.returncode, 1, driver.output)
        self.assertRegex(driver.output, r'A command is \d+\.\d s late: expected at most 1 s, after which a base stops')


if __name__ == '__main__':
    support.main(TestStarvedSender)
