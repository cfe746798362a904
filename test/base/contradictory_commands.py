#!/usr/bin/python3
"""If two nodes drive the base at once with different commands, a warning and /diagnostics name both."""
import re

from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus
from rosgraph_msgs.msg import Log

import support


class TestContradictoryCommands(support.Case):
    def test_both_are_named(self):
        logs, diagnostics = support.Watch('/rosout', Log), support.Watch('/diagnostics', DiagnosticArray)
        commander = support.Commander()
        other = support.Process('rostopic', 'pub', '-r', '20', '/cmd_vel', 'geometry_msgs/Twist', '{angular: {z: 0.5}}')

        def status():
            return next((each for message in diagnostics.messages[-1:] for each in message.status
                         if each.name.endswith('base_controller')), None)

        def named():
            commander.send(0.2)
            return (status() and status().level == DiagnosticStatus.WARN
                    and any('sends' in log.msg for log in logs.messages))
        support.wait_for(named, 'a warning')
        line = next(log.msg for log in logs.messages if 'sends' in log.msg)
        for text in (line, status().message):
            self.assertRegex(text, r'/contradictory_commands\S* sends 0\.2 m/s, 0 rad/s')
            self.assertRegex(text, r'/rostopic\S* sends 0 m/s, 0\.5 rad/s')
        count, = [value.value for value in status().values if value.key == 'Contradictory commands']
        self.assertGreater(int(count), 0)
        self.assertTrue(re.search('/cmd_vel: contradictory commands: .*: expected only one driving node$', line), line)

        # when only one node drives, the status is OK again
        other.kill()

        def well():
            commander.send(0.2)
            return status().level == DiagnosticStatus.OK
        support.wait_for(well, 'a good state in /diagnostics')


if __name__ == '__main__':
    support.main(TestContradictoryCommands)
