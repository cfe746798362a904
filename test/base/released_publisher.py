#!/usr/bin/python3
"""The simulated clock waits for those who drive by it, and for nobody else."""
import time
import unittest

from rosgraph_msgs.msg import Log

import support


class TestOtherStreams(unittest.TestCase):
    def test_released(self):
        support.init_node('released_publisher')
        odom = support.OdomWatch()
        log = support.Watch('/rosout', Log)
        releases = lambda: [m.msg for m in log.messages if 'the clock no longer waits for it' in m.msg]

        # ten commands a second of wall time: nobody who looks at the clock
        steady = support.Commander()

        def stream():
            steady.send(0.1)
            time.sleep(0.1)
            return releases()
        support.wait_for(stream, 'the clock to let go of a stream in wall time')
        self.assertIn('while the clock stands still', releases()[0])

        # from now on its commands do not hold the clock: many ticks pass between two of them
        for _ in range(3):
            steady.send(0.1)
            start = odom.last.header.stamp.to_sec()
            support.wait_for(lambda: odom.last.header.stamp.to_sec() > start + 2, 'the clock to run on')
        self.assertEqual(len(releases()), 1)


if __name__ == '__main__':
    support.main('released_publisher', TestOtherStreams)
