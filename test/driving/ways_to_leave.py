#!/usr/bin/python3
"""However a script leaves its Drive block, its last command is a stop, it exits, and its status says how it went."""
import os

from geometry_msgs.msg import Twist

import support

SCRIPT = os.path.join(os.path.dirname(os.path.realpath(__file__)), 'leaving.py')
STATUS = {'exit_beside_a_timer': 2, 'exit_beside_a_thread': 2, 'error_beside_a_thread': 1, 'error_in_a_thread': 0,
          'hidden_error': 1, 'child_process': 0}


class TestWaysToLeave(support.Case):
    def check(self, name):
        commands = support.Watch('/cmd_vel', Twist)
        script = support.Process(SCRIPT, name)
        self.assertEqual(script.wait(), STATUS[name], script.output)
        support.wait_for(lambda: commands.messages and not commands.subscriber.get_num_connections(), 'all commands')
        self.assertEqual(commands.last.linear.x, 0.0)
        self.assertEqual('a mistake' in script.output, name.endswith('_thread') and name.startswith('error'))


for each in STATUS:
    setattr(TestWaysToLeave, f'test_{each}', lambda self, name=each: self.check(name))

if __name__ == '__main__':
    support.main(TestWaysToLeave)
