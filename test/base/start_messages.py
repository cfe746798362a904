#!/usr/bin/python3
"""What a base logs at its start, and that a silent client does not block it."""
import re
import socket
from xmlrpc.client import ServerProxy

import rospy
from nav_msgs.msg import Odometry

from rbx1_nav.node import resources
from rbx1_nav.node.config import load_yaml
import support


class TestStartMessages(support.Case):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.config = load_yaml(resources.path('config', 'turtlebot.yaml'))

    def base(self, **params):
        """Start a base with the package's own configuration and these parameters."""
        rospy.set_param('/arbotix', dict(self.config, **params))
        return support.Process('rosrun', 'rbx1_nav', 'fake_base.py')

    def messages(self, **params):
        """Return the levels and texts that a base logs until it is ready."""
        base = self.base(**params)
        base.wait_for_line('Ready')
        base.kill()
        return [re.sub(r'^\[(\w+)\] \[.*?\]: ', r'\1 ', line) for line in base.lines]

    def test_ideal(self):
        self.assertEqual(self.messages(), [
            'INFO Ignoring 13 parameters that apply only to hardware', 'INFO Surface: ideal',
            'INFO Ready: base_footprint is at the origin of odom'])

    def test_a_seed(self):
        self.assertIn('INFO Surface: low_ply_carpet; seed:=3 repeats this run',
                      self.messages(surface='low_ply_carpet', seed='3'))

    def test_a_random_seed(self):
        lines = [line for _ in range(2) for line in self.messages(surface='hard_floor', seed='random')
                 if re.fullmatch(r'INFO Surface: hard_floor; seed:=\d+ repeats this run', line)]
        self.assertEqual(len(set(lines)), 2, lines)

    def test_a_client_that_sends_nothing_keeps_nobody_from_connecting(self):
        self.base().wait_for_line('Ready')
        with ServerProxy(rospy.get_master().lookupNode('/arbotix')[2]) as node:
            _, *address = node.requestTopic('/test', '/odom', [['TCPROS']])[2]
        with socket.create_connection(address):
            odom = support.Watch('/odom', Odometry)
            support.wait_for(lambda: odom.last, 'odometry')


if __name__ == '__main__':
    support.main(TestStartMessages)
