#!/usr/bin/python3
"""After a reset during a run, the base names the driving node, and the odometry-based script exits."""

import rospy
from geometry_msgs.msg import Twist
from rosgraph_msgs.msg import Log
from std_srvs.srv import Empty

import support


class TestResetInMidRun(support.Case):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.odom = support.OdomWatch()
        cls.logs = support.Watch('/rosout', Log)
        cls.commands = support.Watch('/cmd_vel', Twist)
        rospy.wait_for_service('/arbotix/reset', support.LIMIT)
        cls.reset_base = rospy.ServiceProxy('/arbotix/reset', Empty)
        cls.idle = support.Commander()      # another node that could drive, but does not
        rospy.wait_for_message('/odom_ekf', rospy.AnyMsg, support.LIMIT)

    def reset(self):
        """Reset the base; return the level and text of the line that it logs."""
        start = len(self.logs.messages)

        def logged():
            return next((log for log in self.logs.messages[start:]
                         if log.name == '/arbotix' and 'Reset' in log.msg), None)
        self.reset_base()
        log = support.wait_for(logged, 'a line of the base')
        return log.level, log.msg

    def start(self, script, *arguments):
        """Run a script until the robot has moved."""
        driver = script(*arguments)
        support.wait_for(lambda: self.odom.position()[0] > 0.1, 'the robot to move')
        return driver

    def check_warning(self):
        self.assertEqual(self.reset(), (Log.WARN, 'Reset while /out_and_back is driving: this run is not valid. '
                                                  'Reset again when it has finished'))

    def check_script(self, *arguments):
        driver = self.start(support.by_odometry, *arguments)
        self.check_warning()
        self.assertEqual(driver.wait(), 1, driver.output)
        errors = [line for line in driver.lines if '[INFO]' not in line and '[WARN]' not in line]
        self.assertEqual(len(errors), 1, driver.output)
        self.assertRegex(errors[0], r'\[ERROR\].*: The base was reset during the run: '
                                    'its pose is no longer measured from the start$')
        self.assertEqual(self.commands.last, Twist())
        self.check_without_a_driver()

    def check_without_a_driver(self):
        # on a busy machine, the base sees the end of the connection after the process has exited
        support.wait_for(lambda: self.reset() == (Log.INFO, 'Reset: base_footprint is back at the origin of odom'),
                         'a reset without a driver')

    def test_a_driver_that_rests_for_long(self):
        self.idle.send()
        start = self.odom.next().header.stamp
        support.wait_for(lambda: (self.odom.last.header.stamp - start).to_sec() > 2, '2 s')
        self.check_without_a_driver()

    def test_by_odometry(self):
        self.check_script('_odom_frame:=odom')

    def test_by_combined_odometry(self):
        self.check_script('_odom_frame:=odom_combined')

    def test_by_time(self):
        driver = self.start(support.out_and_back, '_goal_distance:=0.2')
        # also while it rests between two motions
        support.wait_for(lambda: self.odom.last.twist.twist.linear.x == 0, 'a rest')
        self.check_warning()
        self.assertEqual(driver.wait(), 0, driver.output)
        self.check_without_a_driver()


if __name__ == '__main__':
    support.main(TestResetInMidRun)
