#!/usr/bin/python3
"""The timed script without this package, but with a wait for the base, is exact, and Ctrl-C stops the robot."""
import os
import re
import signal

import rospkg

import support

SCRIPT = os.path.join(rospkg.RosPack().get_path('rbx1_nav'), 'nodes', 'timed_out_and_back.py')
WAIT = """while self.cmd_vel.get_num_connections() == 0 and not rospy.is_shutdown():
            rospy.sleep(0.1)
        rospy.sleep(1)
        if True:"""


def plain_script():
    """Return the script as plain rospy."""
    with open(SCRIPT, encoding='utf-8') as file:
        text = file.read()
    text = text.replace('from rbx1_nav.driving import Drive\n', '').replace('with Drive(self.cmd_vel):', WAIT)
    assert 'get_num_connections' in text and not re.search(r'rbx1_nav(?! timed)', text) and 'Drive(' not in text
    return text


class TestWithoutImport(support.Case):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.odom = support.OdomWatch()

    def start(self, *arguments):
        return support.Process('/usr/bin/python3', self.file(plain_script(), '.py'), *arguments)

    def test_it_is_exact(self):
        commands = self.watch_commands()
        driver = self.start()
        self.assertEqual(driver.wait(), 0, driver.output)
        self.assertEqual(sum(message.linear.x == 0.2 for message in commands.messages), 500)
        self.assertEqual(sum(message.angular.z == 1.0 for message in commands.messages), 314)
        x, y, yaw = support.pose(self.odom.next())
        self.assertAlmostEqual(x, support.EXACT_X, delta=support.MICROMETRE)
        self.assertAlmostEqual(y, support.EXACT_Y, delta=support.MICROMETRE)
        self.assertAlmostEqual(support.wrapped(yaw - support.EXACT_TURN), 0, delta=1e-6)

    def test_signals_stop_the_robot(self):
        for number in signal.SIGINT, signal.SIGTERM:
            driver = self.start('_linear_speed:=0.01')
            self.odom.wait_for_twist(0.01)
            driver.signal(number)
            driver.wait_for_line('Stopping the robot...')
            self.odom.wait_for_twist(0.0)
            driver.kill()


if __name__ == '__main__':
    support.main(TestWithoutImport)
