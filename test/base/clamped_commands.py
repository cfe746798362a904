#!/usr/bin/python3
"""Commands above the limits in the YAML file are clamped, keep their sign, and cause a warning."""
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
        support.wait_for(lambda: any('/cmd_vel: 1 m/s, 0.1 rad/s: expected at most 0.3 and 0.5; clamped' in m.msg
                                     for m in log.messages), 'the warning')


if __name__ == '__main__':
    support.main(TestClampedCommands)
