#!/usr/bin/python3
"""If a base clamps a command, or no longer accepts commands, the run fails with an error that names the base."""
import os
import signal

import rospy

import support

BASE = {'controllers': {'base': {'type': 'diff_controller', 'base_width': 0.26, 'base_frame_id': 'base_footprint',
                                 'max_linear_speed': 0.5}}}


class TestLostListener(support.Case):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        rospy.set_param('/arbotix', BASE)

    def setUp(self):
        self.base = support.Process('rosrun', 'rbx1_nav', 'fake_base.py')
        self.base.wait_for_line('at the origin')
        self.recorder = support.Process('rosrun', 'topic_tools', 'drop', '/cmd_vel', '0', '1', '__name:=recorder')
        support.wait_for(lambda: '/recorder' in self.subscribers(), 'the recorder')

    @staticmethod
    def subscribers():
        """Return the names of the nodes that subscribe to /cmd_vel."""
        return dict(rospy.get_master().getSystemState()[2][1]).get('/cmd_vel', ())

    def drive(self, *arguments, script=support.out_and_back):
        """Run a script until the robot moves."""
        driver = script(*arguments)
        driver.wait_for_line('Connected to /arbotix')
        odom = support.OdomWatch()
        self.addCleanup(odom.subscriber.unregister)
        support.wait_for(lambda: odom.last.twist.twist.linear.x > 0, 'a motion')
        return driver

    def check_error(self, driver, text):
        self.assertEqual(driver.wait(), 1, driver.output)
        self.assertRegex(driver.output, r'\[ERROR\].*: /cmd_vel: ' + text)
        self.assertIn('Stopping the robot...', driver.output)
        self.assertNotIn('Traceback', driver.output)

    def test_the_base_clamps_a_command(self):
        self.check_error(support.out_and_back('_linear_speed:=1'),
                         '/arbotix did not follow a command: 1 m/s, 0 rad/s: expected at most 0.5 m/s')

    def test_the_base_is_killed(self):
        for script in (support.out_and_back, support.by_odometry):
            driver = self.drive('_linear_speed:=0.02', script=script)
            self.base.kill()
            self.check_error(driver, '/arbotix disconnected')
            self.base = support.Process('rosrun', 'rbx1_nav', 'fake_base.py')
            self.base.wait_for_line('at the origin')

    def test_the_base_is_suspended(self):
        pid = support.pid_of('/arbotix')
        driver = self.drive('_linear_speed:=0.02')
        self.addCleanup(os.kill, pid, signal.SIGCONT)
        os.kill(pid, signal.SIGSTOP)
        self.check_error(driver, '/arbotix has stopped responding')
        os.kill(pid, signal.SIGCONT)

    def test_the_base_is_killed_and_the_clock_stops(self):
        for process in self.base, self.recorder:
            process.signal(signal.SIGINT)
            process.wait()
        rospy.set_param('/use_sim_time', True)
        self.addCleanup(rospy.set_param, '/use_sim_time', False)
        rospy.set_param('/arbotix/real_time_factor', 5)
        self.addCleanup(rospy.delete_param, '/arbotix/real_time_factor')
        for script in support.out_and_back, support.by_odometry:
            base = support.Process('rosrun', 'rbx1_nav', 'fake_base.py')
            base.wait_for_line('at the origin')
            driver = script('_linear_speed:=0.01')
            driver.wait_for_line('Connected to /arbotix')
            base.kill()
            self.check_error(driver, '/arbotix disconnected')


if __name__ == '__main__':
    support.main(TestLostListener)
