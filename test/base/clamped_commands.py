#!/usr/bin/python3
"""Commands above the limits in the YAML file are clamped, keep their sign, and cause a warning; a timed script fails,
as it does with commands that come too late."""
from rosgraph_msgs.msg import Log

import support


class TestClampedCommands(support.Case):
    def test_commands_are_clamped_to_the_limits(self):
        odom = support.OdomWatch()
        log = support.Watch('/rosout', Log)
        commander = support.Commander()
        for commanded, clamped in [((0.2, 0.1), (0.2, 0.1)), ((1.0, 0.1), (0.3, 0.1)), ((-1.0, 2.0), (-0.3, 0.5)),
                                   ((0.1, -2.0), (0.1, -0.5))]:
            commander.send(*commanded)
            odom.wait_for_twist(*clamped, since=0)
        support.wait_for(lambda: any('/cmd_vel: 1 m/s, 0.1 rad/s: expected at most 0.3 m/s, 0.5 rad/s; clamped' in m.msg
                                     for m in log.messages), 'the warning')

    def check(self, script, status, text):
        self.assertEqual(script.wait(), status, script.output)
        self.assertIn(text, script.output)

    def test_a_script_fails_if_it_relies_on_each_command(self):
        self.check(support.out_and_back('_linear_speed:=1'), 1,
                   'rad/s: expected at most 0.3 m/s, 0.5 rad/s: expected it to follow the commands until the end')
        self.check(support.out_and_back('_rate:=2', '_linear_speed:=0.2', '_angular_speed:=0.4'), 1,
                   '/arbotix did not follow a command: no command for 0.4 s: stopped')
        self.check(support.by_odometry('_rate:=20', '_linear_speed:=1'), 0, 'Measured in odom')


if __name__ == '__main__':
    support.main(TestClampedCommands)
