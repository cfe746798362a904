#!/usr/bin/python3
"""Without a recent transform, the robot stops; it continues with a new one, otherwise the script exits in time."""
import os
import signal

import support


class TestLostTransform(support.Case):
    def setUp(self):
        self.odom = support.OdomWatch()
        self.base = support.pid_of('/arbotix')
        self.addCleanup(os.kill, self.base, signal.SIGCONT)
        self.commands = self.watch_commands()

    def suspend_base(self, *arguments):
        """Suspend the base during an odometry-based run; return the script once it has stopped the robot."""
        driver = support.by_odometry('_linear_speed:=0.1', *arguments)
        self.odom.wait_for_twist(0.1)
        os.kill(self.base, signal.SIGSTOP)
        driver.wait_for_line(r'\[WARN\].*last transform from odom to base_footprint is .* s old: '
                             'stopping the robot until there is a new one')
        support.wait_for(lambda: self.commands.last.linear.x == 0, 'a command to stop')
        return driver

    def test_after_the_timeout_the_script_ends_with_an_error(self):
        driver = self.suspend_base('_transform_timeout:=1')
        self.assertEqual(driver.wait(), 1, driver.output)
        errors = [line for line in driver.lines if '[ERROR]' in line]
        self.assertEqual(len(errors), 1, driver.output)
        self.assertIn("Timed out after 1 s waiting for the robot's pose: The last transform from odom to", errors[0])
        self.assertNotIn('Traceback', driver.output)
        moving = [command.linear.x != 0 for command in self.commands.messages]
        self.assertFalse(any(moving[moving.index(False):]), 'commands to move after the stop')

    def test_a_new_transform_continues_the_run(self):
        driver = self.suspend_base('_transform_timeout:=60', '_goal_distance:=0.3')
        os.kill(self.base, signal.SIGCONT)
        self.assertEqual(driver.wait(), 0, driver.output)
        self.assertRegex(driver.output, r'0\.00 m forward, 3\.\d+ rad to the left')


if __name__ == '__main__':
    support.main(TestLostTransform)
