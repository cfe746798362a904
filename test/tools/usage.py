#!/usr/bin/python3
"""Each executable prints its usage for -h and --help, even without a master, and rejects unknown arguments."""
import os

import rospkg

import support

NODES = ['calibrate_angular.py', 'calibrate_linear.py', 'ekf.py', 'fake_base.py', 'fake_create.py', 'odom_ekf.py',
         'odom_out_and_back.py', 'pose.py', 'timed_out_and_back.py']
NO_MASTER = 'ROS_MASTER_URI=http://127.0.0.1:1'


class TestUsage(support.Case):
    def run_to_its_end(self, name, *arguments):
        node = os.path.join(rospkg.RosPack().get_path('rbx1_nav'), 'nodes', name)
        process = support.Process('env', NO_MASTER, '/usr/bin/python3', node, *arguments)
        return process.wait(), process

    def test_help(self):
        for name, argument in [(name, '--help') for name in NODES + ['fit_surface.py', 'simulate.py']] + [
                ('ekf.py', '-h'), ('simulate.py', '-h')]:
            status, process = self.run_to_its_end(name, argument)
            self.assertEqual(status, 0, process.output)
            self.assertIn(f'usage: {name}', process.output)
            self.assertNotIn('master', process.output)

    def test_unknown_arguments(self):
        for name in NODES:
            status, process = self.run_to_its_end(name, '0.1')
            self.assertEqual(status, 2, process.output)
            self.assertIn(f'usage: {name}', process.output)
            self.assertEqual(process.lines[-1], '%s: error: 0.1: unknown argument: expected _parameter:=value or '
                                                'topic:=new_topic' % name)


if __name__ == '__main__':
    support.main(TestUsage)
