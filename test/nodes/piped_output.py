#!/usr/bin/python3
"""The output of a program reaches a pipe while the program is running, not when it exits."""
import signal

import support

CASES = [(('rosrun', 'rbx1_nav', 'timed_out_and_back.py'), r'INFO.*Waiting for a base'),
         (('roslaunch', 'rbx1_nav', 'fake_turtlebot.launch'), r'INFO.*Ready: base_footprint'),
         # this number of runs takes hours
         (('rosrun', 'rbx1_nav', 'simulate.py', '--runs', '1000000', '--jobs', '1'),
          r'1000000 runs of each method on ideal')]


class TestPipedOutput(support.Case):
    def run_buffered(self, *command):
        """Run a command as a user does, unlike the unbuffered Process of the other tests."""
        return self.start('env', '-u', 'PYTHONUNBUFFERED', *command)

    def test_a_line_arrives_while_the_program_runs(self):
        for command, line in CASES:
            process = self.run_buffered(*command)
            process.wait_for_line(line)
            self.assertIsNone(process.process.poll(), process.output)
            process.signal(signal.SIGINT)
            process.wait()

    def test_a_reader_that_leaves_causes_no_traceback(self):
        reader = self.run_buffered(
            'bash', '-c', 'rosrun rbx1_nav pose.py --help | true; echo "status ${PIPESTATUS[0]}"')
        self.assertEqual(reader.wait(), 0)
        self.assertEqual(reader.lines, ['status 0'])


if __name__ == '__main__':
    support.main(TestPipedOutput)
