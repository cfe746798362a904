#!/usr/bin/python3
"""Stop while another driver, the base or the master is frozen: the page shows in red what may still move, until a later
Stop is answered, also when the frozen process runs again."""
from contextlib import contextmanager
import os
import signal

import rospy

import support
from browser import Page, PageTest

SPEED = 0.2     # m/s
PUBLISH = ['rostopic', 'pub', '-r', '10', '/cmd_vel', 'geometry_msgs/Twist', f'{{linear: {{x: {SPEED}}}}}']


@contextmanager
def frozen(pid):
    """A process is frozen."""
    os.kill(pid, signal.SIGSTOP)
    try:
        yield
    finally:
        os.kill(pid, signal.SIGCONT)


class TestBrowserFrozen(PageTest):
    def setUp(self):
        self.page = Page(self.driver, self.url)
        self.odom.wait_for_twist(0.0)
        self.driver_node = self.start(*PUBLISH)
        self.odom.wait_for_twist(SPEED)
        self.page.wait_for_text('run-state', 'Running: /rostopic')

    def wait_for_alarm(self, pattern):
        """Wait for a message in red."""
        self.page.wait_for_text('notice', pattern)
        self.assertEqual(self.page.find('#notice p').get_attribute('class'), 'alarm')

    def stop_again(self):
        """Stop the robot, which removes the message."""
        self.page.click('#stop')
        support.wait_for(lambda: not self.page.find('#notice').is_displayed(), 'the message to disappear')
        self.page.wait_for_text('run-state', r'The robot was stationary')
        self.odom.wait_for_twist(0.0)

    def test_another_driver(self):
        with frozen(self.driver_node.process.pid):
            self.page.click('#stop')
            self.wait_for_alarm('No answer from /rostopic_.*: the robot may move again')
            self.odom.wait_for_twist(0.0)
            self.page.wait_for_text('run-state', 'No answer from /rostopic_')
        self.driver_node.wait()     # the request to shut down has waited in its socket
        self.wait_for_alarm('No answer from /rostopic_')
        self.stop_again()

    def test_the_base(self):
        with frozen(support.pid_of('/arbotix')):
            self.page.click('#stop')
            self.wait_for_alarm(r'no odometry later than 0\.\d s after Stop: the robot may still be moving')
            self.page.wait_for_text('run-state', 'the robot may still be moving')
            self.driver_node.wait()
        self.odom.wait_for_twist(0.0)
        self.wait_for_alarm('the robot may still be moving')
        self.stop_again()

    def test_the_master(self):
        with frozen(rospy.get_master().getPid()[2]):
            self.page.click('#stop')
            # the view is connected with the other driver; rospy shuts it down as soon as the master answers
            self.wait_for_alarm('No answer from /rostopic_.* and the master: the robot may move again')
        self.driver_node.wait()
        self.wait_for_alarm('No answer from /rostopic_')
        self.stop_again()


if __name__ == '__main__':
    support.main(TestBrowserFrozen)
