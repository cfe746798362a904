#!/usr/bin/python3
"""Simulated time that jumps, stops or jumps back never moves the robot farther than timeout times speed."""
import math

import rospy
from tf2_msgs.msg import TFMessage

import support

MAX_TRAVEL = 1.0 * 0.2 + support.MICROMETRE     # timeout times speed, m


class TestTimeJumps(support.Case):
    def test_jumps_of_simulated_time(self):
        clock = support.OwnClock(1000.0)
        commander = support.Commander()
        transforms = support.Watch('/tf', TFMessage)
        # OdomWatch would wait for odometry, and there is none before simulated time begins
        odom = support.Watch('/odom', support.Odometry)
        # rospy itself subscribes to /clock, and then the base does: wait for the second subscription
        support.wait_for(lambda: clock.publish(clock.now + 0.02) or odom.last, '/odom')

        def jump(seconds):
            """Publish a later time; return the odometry that follows. seconds: the difference."""
            count = len(odom.messages)
            clock.publish(clock.now + seconds)
            support.wait_for(lambda: len(odom.messages) > count, 'odometry')
            return odom.last

        def drive():
            """Send a command; return the position as soon as it is in force, m."""
            commander.send(0.2)
            support.wait_for(lambda: jump(0.02).twist.twist.linear.x == 0.2, 'the command in force')
            return odom.last.pose.pose.position.x

        # forward by an hour: the command times out
        start = drive()
        message = jump(3600)
        self.assertLessEqual(message.pose.pose.position.x - start, MAX_TRAVEL)
        self.assertEqual(message.twist.twist.linear.x, 0)

        # back by half an hour: the command is dropped
        start = drive()
        message = jump(-1800)
        self.assertAlmostEqual(message.pose.pose.position.x, start, delta=support.MICROMETRE)
        self.assertEqual(message.twist.twist.linear.x, 0)
        self.assertAlmostEqual(message.header.stamp.to_sec(), clock.now, delta=1e-6)

        # stopped clock: the same time again does not lead to odometry
        start = drive()
        count = len(odom.messages)
        for _ in range(50):
            clock.publish(clock.now)
        message = jump(0.02)    # arrives after the fifty messages
        self.assertEqual(len(odom.messages), count + 1)
        self.assertAlmostEqual(message.pose.pose.position.x - start, 0.2 * 0.02, delta=support.MICROMETRE)

        # after all this, the base still drives
        self.assertGreater(drive(), message.pose.pose.position.x)

        values = [v for m in odom.messages for v in (m.pose.pose.position.x, m.pose.pose.position.y,
                                                     m.pose.pose.orientation.z, m.pose.pose.orientation.w)]
        self.assertTrue(all(map(math.isfinite, values)))
        stamps = [t.header.stamp for m in transforms.messages for t in m.transforms]
        backwards = [b - a for a, b in zip(stamps, stamps[1:]) if b <= a]
        self.assertEqual(len(backwards), 1, 'only the stamp after the jump back is earlier')
        self.assertLess(backwards[0], rospy.Duration(-1700))
        self.assertEqual(len(stamps), len(set(stamps)), 'no two transforms with one stamp')


if __name__ == '__main__':
    support.main(TestTimeJumps)
