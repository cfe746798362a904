#!/usr/bin/python3
"""A Twist with values that are not finite is rejected: it stops the base, is counted, and does not affect odometry."""
import math

from diagnostic_msgs.msg import DiagnosticArray
from rosgraph_msgs.msg import Log

import support


class TestRejectedCommands(support.Case):
    def test_values_that_are_not_finite_are_rejected(self):
        odom = support.OdomWatch()
        diagnostics = support.Watch('/diagnostics', DiagnosticArray)
        logs = support.Watch('/rosout', Log)
        commander = support.Commander()
        bad = [support.twist(math.nan), support.twist(0.2, math.inf), support.twist(0.2), support.twist(0.2)]
        bad[2].linear.y = -math.inf
        bad[3].linear.y = math.nan

        for count, message in enumerate(bad, 1):
            start = len(odom.messages)
            commander.send(0.2)
            odom.wait_for_twist(0.2, since=start)
            start = len(odom.messages)
            commander.publisher.publish(message)
            odom.wait_for_twist(0.0)
            self.assertTrue(all(math.isfinite(m.pose.pose.position.x) for m in odom.messages))

            def counted():
                values = {v.key: v.value for m in diagnostics.messages[-1:] for s in m.status for v in s.values}
                return values.get('Rejected commands') == str(count)
            support.wait_for(counted, '%d rejected commands in /diagnostics' % count)
            self.assertGreater(len(odom.messages), start)

        # a rejected command is not also reported as ignored
        lateral = support.twist(0.1)
        lateral.linear.y = 0.1
        commander.publisher.publish(lateral)
        odom.wait_for_twist(0.1, since=0)
        support.wait_for(lambda: any('ignored' in log.msg for log in logs.messages), 'the line on a lateral velocity')
        self.assertEqual([log.msg for log in logs.messages if 'linear.y' in log.msg and '0.1' not in log.msg], [])


if __name__ == '__main__':
    support.main(TestRejectedCommands)
