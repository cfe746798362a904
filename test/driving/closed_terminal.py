#!/usr/bin/python3
"""If the terminal is closed while the robot is driving, the robot stops, and /rosout receives the last two lines."""
import fcntl
import os
import pty
import signal
import subprocess
import termios

from rosgraph_msgs.msg import Log

import support


class TestClosedTerminal(support.Case):
    def test_the_robot_stops(self):
        odom = support.OdomWatch()
        log = support.Watch('/rosout', Log)
        ours, theirs = pty.openpty()

        def become_session_leader():
            os.setsid()
            fcntl.ioctl(theirs, termios.TIOCSCTTY, 0)
        driver = subprocess.Popen(['rosrun', 'rbx1_nav', 'timed_out_and_back.py', '_linear_speed:=0.01'], stdin=theirs,
                                  stdout=theirs, stderr=theirs, preexec_fn=become_session_leader)
        self.addCleanup(driver.wait)
        self.addCleanup(driver.kill)
        os.close(theirs)
        odom.wait_for_twist(0.01)
        log.wait_for_publisher('/out_and_back')
        os.close(ours)
        support.wait_for(lambda: driver.poll() is not None, 'the driver to exit')
        self.assertEqual(driver.returncode, 128 + signal.SIGHUP)
        odom.wait_for_twist(0.0)
        for line in ('Stopping the robot...', 'Out-and-Back node terminated.'):
            support.wait_for(lambda: any(m.msg == line for m in log.messages), f'{line} on /rosout')


if __name__ == '__main__':
    support.main(TestClosedTerminal)
