#!/usr/bin/python3
"""A Twist that is not finite is refused, stops the base, is counted, and leaves no trace in the odometry."""
import math
import unittest

from diagnostic_msgs.msg import DiagnosticArray

import support


class TestRefusedNaN(unittest.TestCase):
    def test_refused(self):
        support.init_node('rejected_commands')
        odom = support.OdomWatch()
        diagnostics = support.Watch('/diagnostics', DiagnosticArray)
        commander = support.Commander()
        bad = [support.twist(math.nan), support.twist(0.2, math.inf), support.twist(0.2)]
        bad[2].linear.y = -math.inf

        for count, message in enumerate(bad, 1):
            commander.send(0.2)
            odom.wait_for_twist(0.2)
            start = len(odom.messages)
            commander.publisher.publish(message)
            odom.wait_for_twist(0.0)

            # had the timeout stopped it, it would have moved 0.2 m since its command
            self.assertTrue(all(math.isfinite(m.pose.pose.position.x) for m in odom.messages))

            def refused():
                values = {v.key: v.value for m in diagnostics.messages[-1:] for s in m.status for v in s.values}
                return values.get('Refused commands') == str(count)
            support.wait_for(refused, '%d refused commands in /diagnostics' % count)
            self.assertGreater(len(odom.messages), start)


if __name__ == '__main__':
    support.main('rejected_commands', TestRefusedNaN)
