#!/usr/bin/python3
"""A second driving script takes over the name of the first, which stops the robot and exits; the second finishes."""
import signal

from rosgraph_msgs.msg import Log

import support


class TestTwoDrivers(support.Case):
    def test_the_second_one_takes_over(self):
        odom = support.OdomWatch()
        log = support.Watch('/rosout', Log)
        first = support.out_and_back('_linear_speed:=0.01')
        odom.wait_for_twist(0.01)
        second = support.out_and_back('_linear_speed:=0.2')
        self.assertEqual(first.wait(), 128 + signal.SIGTERM, first.output)
        self.assertIn('Stopping the robot...', first.output)
        status = second.wait()
        self.assertEqual(status, 0, [second.output] + [each.msg for each in log.messages if each.level >= Log.WARN])
        self.assertEqual(second.output.count('157 commands in 3.14 s'), 2, second.output)
        self.assertNotIn('Out-and-Back node terminated.', second.output)


if __name__ == '__main__':
    support.main(TestTwoDrivers)
