#!/usr/bin/python3
"""After a signal or `rosnode kill` during a motion, the last command is a stop, and both lines are logged."""
import os
import signal
import subprocess

import rospy
from geometry_msgs.msg import Twist

import support


class TestStopOnSignal(support.Case):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.odom = support.OdomWatch()

    def check(self, end):
        """Check the reaction to end(driver), which shuts down the driving script while the robot is moving."""
        commands = support.Watch('/cmd_vel', Twist)
        self.addCleanup(commands.subscriber.unregister)
        # slow, so that the motion lasts until the shutdown
        driver = support.out_and_back('_linear_speed:=0.01')
        self.odom.wait_for_twist(0.01)
        end(driver)
        driver.wait()
        self.assertIn('Stopping the robot...', driver.output)
        self.assertIn('Out-and-Back node terminated.', driver.output)
        self.assertNotIn('Traceback', driver.output)
        moves = [m.linear.x != 0 for m in commands.messages]
        self.assertEqual(moves[-2:], [True, False], 'a stop after the last command to move, and nothing after it')
        self.assertEqual(moves.count(False), 1)

    def check_suspended(self, pid):
        """Send SIGINT while another process is suspended."""
        def end(driver):
            os.kill(pid, signal.SIGSTOP)
            driver.signal(signal.SIGINT)
            try:
                driver.wait()
            finally:
                os.kill(pid, signal.SIGCONT)
        self.check(end)
        self.odom.wait_for_twist(0.0)

    def check_end(self, end):
        """Check that the exit status is 0 and the robot is stationary."""
        status = []
        self.check(lambda driver: (end(driver), status.append(driver.wait())))
        self.assertEqual(status, [0])
        self.odom.wait_for_twist(0.0)

    def test_sigint(self):
        self.check_end(lambda driver: driver.signal(signal.SIGINT))

    def test_sigterm(self):
        self.check_end(lambda driver: driver.signal(signal.SIGTERM))

    def test_sighup(self):
        self.check_end(lambda driver: driver.signal(signal.SIGHUP))

    def test_rosnode_kill(self):
        self.check_end(lambda driver: subprocess.run(['rosnode', 'kill', '/out_and_back'], check=True))

    def test_sigint_while_the_master_is_suspended(self):
        self.check_suspended(rospy.get_master().getPid()[2])

    def test_sigint_while_the_simulated_clock_stands_still(self):
        self.check_suspended(support.pid_of('/arbotix'))


if __name__ == '__main__':
    support.main(TestStopOnSignal)
