#!/usr/bin/python3
"""The driving script waits for a base and for all live subscribers, and ignores dead ones."""
import signal

import rospy
from geometry_msgs.msg import Twist

import support

LISTENER = ("import rospy; from geometry_msgs.msg import Twist; rospy.init_node('listener'); "
            "rospy.Subscriber('cmd_vel', Twist); print('ready', flush=True); rospy.spin()")


class TestWaitForBase(support.Case):
    def base(self, name):
        rospy.set_param(name, {'controllers': {'base': {'type': 'diff_controller', 'base_width': 0.26}}})
        process = support.Process('rosrun', 'rbx1_nav', 'fake_base.py', f'__name:={name}')
        process.wait_for_line('at the origin')
        return process

    def test_it_waits_and_then_drives(self):
        other = rospy.Subscriber('/mobile_base/commands/velocity', Twist)
        driver = support.out_and_back()
        driver.wait_for_line('Waiting for a base that subscribes to /cmd_vel. Other Twist topics have subscribers: '
                             '/mobile_base/commands/velocity. To use one, add cmd_vel:=/mobile_base/commands/velocity')
        other.unregister()
        commands = self.watch_commands()
        driver.wait_for_line('Connected to ')
        driver.signal(signal.SIGTERM)
        driver.wait()
        # the very first command has arrived
        self.assertEqual(commands.messages[0].linear.x, 0.2)

    def test_a_base_that_does_not_answer_is_waited_for_and_any_other_node_is_ignored(self):
        base, listener = self.base('base'), support.Process('/usr/bin/python3', '-c', LISTENER)
        listener.wait_for_line('ready')
        for process in base, listener:
            process.signal(signal.SIGSTOP)
            # a regular exit, so that the node is unregistered
            self.addCleanup(process.wait)
            self.addCleanup(process.signal, signal.SIGTERM)
            self.addCleanup(process.signal, signal.SIGCONT)
        commands = self.watch_commands()
        driver = support.out_and_back()
        driver.wait_for_line(r'/listener is registered as a subscriber of /cmd_vel but does not answer: ignored')
        driver.wait_for_line('Waiting for /base to answer')
        self.assertEqual(commands.messages, [])
        base.signal(signal.SIGCONT)
        driver.wait_for_line('Connected to ')
        driver.signal(signal.SIGTERM)
        driver.wait()


if __name__ == '__main__':
    support.main(TestWaitForBase)
