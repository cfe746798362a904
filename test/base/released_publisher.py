#!/usr/bin/python3
"""The simulated clock does not wait for a publisher of /cmd_vel that does not use it."""
import time

from rosgraph_msgs.msg import Log

import support


class TestReleasedPublisher(support.Case):
    def test_a_publisher_on_wall_time_does_not_hold_the_clock(self):
        odom = support.OdomWatch()
        log = support.Watch('/rosout', Log)

        def releases():
            return [m.msg for m in log.messages if 'not in step with /clock' in m.msg]

        # ten commands per second of wall time
        commander = support.Commander()

        def stream():
            commander.send(0.1)
            time.sleep(0.1)
            return releases()
        support.wait_for(stream, 'the warning that it is not in step')
        self.assertIn('does not subscribe to /clock', releases()[0])

        # many ticks pass between two commands
        for _ in range(3):
            commander.send(0.1)
            start = odom.last.header.stamp.to_sec()
            support.wait_for(lambda: odom.last.header.stamp.to_sec() > start + 2, 'two seconds of simulated time')
        self.assertEqual(len(releases()), 1)


if __name__ == '__main__':
    support.main(TestReleasedPublisher)
