#!/usr/bin/python3
"""Simulated time that leaps, stands or goes back never moves the robot by more than timeout times its speed."""
import math
import unittest

import rospy
from tf2_msgs.msg import TFMessage

import support

MOST = 1.0 * 0.2 + support.MICROMETRE    # timeout times speed, m


class TestTimeJumps(unittest.TestCase):
    def test_jumps(self):
        support.init_node('time_jumps')
        clock = support.OwnClock(1000.0)
        commander = support.Commander()
        transforms = support.Watch('/tf', TFMessage)
        # subscribing waits for odometry, and there is none before there is time
        odom = support.Watch('/odom', support.Odometry)
        # rospy listens to /clock once for itself and once for the base: wait for the base's
        support.wait_for(lambda: clock.publish(clock.now + 0.02) or odom.last, '/odom')

        def jump(seconds):
            """Publish a time that much later; the odometry that answers."""
            count = len(odom.messages)
            clock.publish(clock.now + seconds)
            support.wait_for(lambda: len(odom.messages) > count, 'odometry')
            return odom.last

        def drive():
            """Bring a command into force; where the robot is then, m."""
            commander.send(0.2)
            support.wait_for(lambda: jump(0.02).twist.twist.linear.x == 0.2, 'the command to be in force')
            return odom.last.pose.pose.position.x

        # forward by an hour: the timeout ends the command
        start = drive()
        message = jump(3600)
        self.assertLessEqual(message.pose.pose.position.x - start, MOST)
        self.assertEqual(message.twist.twist.linear.x, 0)

        # back by half an hour: the command is forgotten
        start = drive()
        message = jump(-1800)
        self.assertAlmostEqual(message.pose.pose.position.x, start, delta=support.MICROMETRE)
        self.assertEqual(message.twist.twist.linear.x, 0)
        self.assertAlmostEqual(message.header.stamp.to_sec(), clock.now, delta=1e-6)

        # standing still: the same time again and again says nothing new
        start = drive()
        count = len(odom.messages)
        for _ in range(50):
            clock.publish(clock.now)
        message = jump(0.02)    # comes after the fifty
        self.assertEqual(len(odom.messages), count + 1)
        self.assertAlmostEqual(message.pose.pose.position.x - start, 0.2 * 0.02, delta=support.MICROMETRE)

        # it drives on after all that
        self.assertGreater(drive(), message.pose.pose.position.x)

        values = [v for m in odom.messages for v in (m.pose.pose.position.x, m.pose.pose.position.y,
                                                     m.pose.pose.orientation.z, m.pose.pose.orientation.w)]
        self.assertTrue(all(map(math.isfinite, values)))
        stamps = [t.header.stamp for m in transforms.messages for t in m.transforms]
        backwards = [b - a for a, b in zip(stamps, stamps[1:]) if b <= a]
        self.assertEqual(len(backwards), 1, 'only the jump back goes back')
        self.assertLess(backwards[0], rospy.Duration(-1700))
        self.assertEqual(len(stamps), len(set(stamps)), 'no two transforms with one stamp')


if __name__ == '__main__':
    support.main('time_jumps', TestTimeJumps)
