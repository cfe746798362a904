#!/usr/bin/python3
"""After a signal, `rosnode kill` or the loss of its terminal during a motion, the last commands of a script are stops,
and both lines are logged."""
import fcntl
import os
import pty
import signal
import subprocess
import termios

import rospy
from rosgraph_msgs.msg import Log

import support


class TestStopOnSignal(support.Case):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.odom = support.OdomWatch()

    def check(self, end, number):
        """Check the reaction to end(driver), which shuts down the driving script while the robot is moving.

        number: of the signal, to which the exit status adds 128.
        """
        commands = self.watch_commands()
        # slow, so that the motion lasts until the shutdown
        driver = support.out_and_back('_linear_speed:=0.01')
        self.odom.wait_for_twist(0.01)
        end(driver)
        self.assertEqual(driver.wait(), 128 + number, driver.output)
        self.assertIn('Stopping the robot...', driver.output)
        self.assertIn('Out-and-Back node terminated.', driver.output)
        self.assertNotIn('Traceback', driver.output)
        moves = [m.linear.x != 0 for m in commands.messages]
        # one at once, and one by shutdown()
        self.assertEqual(moves[-3:], [True, False, False], 'two stops after the last command to move')
        self.assertEqual(moves.count(False), 2)

    def check_suspended(self, pid):
        """Send SIGINT while another process is suspended."""
        def end(driver):
            os.kill(pid, signal.SIGSTOP)
            driver.signal(signal.SIGINT)
            try:
                driver.wait()
            finally:
                os.kill(pid, signal.SIGCONT)
        self.check(end, signal.SIGINT)
        self.odom.wait_for_twist(0.0)

    def test_signals(self):
        for number in signal.SIGINT, signal.SIGTERM, signal.SIGHUP:
            self.check(lambda driver: driver.signal(number), number)
            self.odom.wait_for_twist(0.0)

    def test_rosnode_kill(self):
        self.check(lambda _: subprocess.run(['rosnode', 'kill', '/out_and_back'], check=True), signal.SIGTERM)
        self.odom.wait_for_twist(0.0)

    def test_closed_terminal(self):
        log, (ours, theirs) = support.Watch('/rosout', Log), pty.openpty()

        def become_session_leader():
            os.setsid()
            fcntl.ioctl(theirs, termios.TIOCSCTTY, 0)
        driver = subprocess.Popen(['rosrun', 'rbx1_nav', 'timed_out_and_back.py', '_linear_speed:=0.01'], stdin=theirs,
                                  stdout=theirs, stderr=theirs, preexec_fn=become_session_leader)
        self.addCleanup(driver.wait)
        self.addCleanup(driver.kill)
        os.close(theirs)
        self.odom.wait_for_twist(0.01)
        log.wait_for_publisher('/out_and_back')
        os.close(ours)
        self.assertEqual(driver.wait(support.LIMIT), 128 + signal.SIGHUP)
        self.odom.wait_for_twist(0.0)
        for line in ('Stopping the robot...', 'Out-and-Back node terminated.'):
            support.wait_for(lambda: any(m.msg == line for m in log.messages), f'{line} on /rosout')

    def test_sigint_while_the_master_is_suspended(self):
        self.check_suspended(rospy.get_master().getPid()[2])

    def test_sigint_while_the_simulated_clock_stands_still(self):
        self.check_suspended(support.pid_of('/arbotix'))


if __name__ == '__main__':
    support.main(TestStopOnSignal)
