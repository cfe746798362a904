#!/usr/bin/python3
"""Without a master, the scripts give up with one line; bases and filter log that they are waiting, and then start."""
import os
import signal
import sys

import rospkg

import support

sys.path.insert(0, os.path.join(rospkg.RosPack().get_path('rbx1_nav'), 'test'))
from ports import free_port

SCRIPTS = ['timed_out_and_back.py', 'odom_out_and_back.py', 'calibrate_linear.py', 'calibrate_angular.py']
WAITING = ['fake_base.py', 'turtlebot_node.py', 'fake_create.py', 'ekf.py', 'odom_ekf.py', 'true_robot.py']
BASE = '_controllers:={base: {type: diff_controller, base_width: 0.26}}'


class TestNoMaster(support.Case):
    def setUp(self):
        self.port = free_port()
        self.uri = 'http://127.0.0.1:%d' % self.port

    def start(self, *command):
        return support.Process(*command, ROS_MASTER_URI=self.uri)

    def node(self, *command):
        return self.start('rosrun', 'rbx1_nav', *command)

    def test_a_script_gives_up(self):
        for script in SCRIPTS:
            node = self.node(script, '_wait_timeout:=1')
            self.assertEqual(node.wait(), 1, node.output)
            self.assertEqual(len(node.lines), 2, node.output)
            self.assertRegex(node.lines[0], rf'^\[INFO\].*Waiting for the master at {self.uri}$')
            self.assertRegex(node.lines[1], r'^\[ERROR\].*The master at %s does not answer \(timed out after 1 s\): '
                                            r'expected a running roscore$' % self.uri)

    def test_ctrl_c_while_a_node_waits(self):
        for name in WAITING + SCRIPTS:
            node = self.node(name)
            node.wait_for_line(f'Waiting for the master at {self.uri}')
            node.signal(signal.SIGINT)
            self.assertEqual(node.wait(), 130 if name in SCRIPTS else 0, node.output)
            self.assertFalse([line for line in node.lines if not line.startswith('[INFO]')], node.output)

    def test_a_base_that_is_started_before_the_master(self):
        base, script = self.node('fake_base.py', BASE), self.node('timed_out_and_back.py')
        for node in base, script:
            node.wait_for_line('Waiting for the master')
        master = self.start('roscore', '-p', str(self.port))
        self.addCleanup(master.wait)        # roscore stops its processes, which are not in its process group
        self.addCleanup(master.signal, signal.SIGINT)
        base.wait_for_line('Ready: base_link is at the origin of odom')
        script.wait_for_line('Connected to /arbotix')
        self.assertEqual(base.output.count('Waiting'), 1, base.output)
        self.assertNotIn('register', base.output)       # rospy's own line for this


if __name__ == '__main__':
    support.main(TestNoMaster)
