#!/usr/bin/python3
"""Parameters that an earlier command left on the master are named, with the command that deletes them."""
import signal
import subprocess

import rospy

import support

LAUNCH = """<launch>
  <node name="out_and_back" pkg="rbx1_nav" type="timed_out_and_back.py" output="screen" required="true">
    <param name="goal_distance" value="0.1"/>
    %s
  </node>
</launch>"""
FORGET = 'rosparam delete /out_and_back'


class TestRememberedParameters(support.Case):
    def tearDown(self):
        if rospy.has_param('/out_and_back'):
            rospy.delete_param('/out_and_back')

    def warnings(self, driver):
        """Return the warnings that a script logs until it has checked its parameters, without time stamps."""
        driver.wait_for_line('Connected to ')
        driver.signal(signal.SIGINT)
        driver.wait()
        return [line.split(']: ', 1)[1] for line in driver.lines if '[WARN]' in line]

    def roslaunch(self, more):
        """Run the script with roslaunch, with one parameter and `more`."""
        return support.Process('roslaunch', self.file(LAUNCH % more, '.launch'))

    def test_what_is_still_in_force(self):
        self.assertEqual(self.warnings(support.out_and_back('_goal_distance:=0.2', '_rate:=40')), [])
        expected = 'Parameters from an earlier run still apply: goal_distance = 0.2%s (`%s` clears them)'
        # a parameter that this command line sets again causes no warning
        self.assertEqual(self.warnings(support.by_odometry('_rate:=50')), [expected % ('', FORGET)])
        self.assertEqual(self.warnings(support.out_and_back()), [expected % (', rate = 50', FORGET)])
        subprocess.run(FORGET.split(), check=True)
        self.assertEqual(self.warnings(support.out_and_back()), [])

    def test_what_has_no_effect(self):
        # both scripts have the same name: the parameters of one are on the master when the other one runs
        self.assertEqual(self.warnings(support.by_odometry('_odom_frame:=odom')), [])
        rospy.set_param('/out_and_back/goal_distanc', 0.2)
        expected = 'Ignoring parameters from an earlier run: %s (`%s` clears them)'
        self.assertEqual(self.warnings(support.out_and_back()), [
            expected % ('goal_distanc (did you mean goal_distance?), odom_frame', FORGET)])

    def test_what_a_launch_file_sets_is_no_surprise(self):
        self.assertEqual(self.warnings(self.roslaunch('')), [])
        self.assertEqual(self.warnings(self.roslaunch('<param name="goal_angl" value="1"/>')),
                         ['Ignoring unknown parameters: goal_angl (did you mean goal_angle?)'])


if __name__ == '__main__':
    support.main(TestRememberedParameters)
