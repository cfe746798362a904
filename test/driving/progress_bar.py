#!/usr/bin/python3
"""Both driving scripts draw a progress bar for each motion in a terminal."""
import fcntl
import os
import re
import struct
import subprocess
import termios
import threading

import support


def output_in_a_terminal(*command):
    """Run a command in its own terminal; return its exit status and all its output."""
    terminal, child_end = os.openpty()
    fcntl.ioctl(terminal, termios.TIOCSWINSZ, struct.pack('HHHH', 24, 80, 0, 0))    # rows and columns
    process = subprocess.Popen(command, stdin=child_end, stdout=child_end, stderr=child_end, start_new_session=True)
    os.close(child_end)
    timer = threading.Timer(support.LIMIT, process.kill)
    timer.start()
    output = b''
    try:
        while True:
            output += os.read(terminal, 65536)
    except OSError:     # the other side is closed
        pass
    finally:
        timer.cancel()
        os.close(terminal)
    return process.wait(), output.decode()


class TestProgressBar(support.Case):
    def check(self, script, forward, turn):
        status, output = output_in_a_terminal('rosrun', 'rbx1_nav', script, '_goal_distance:=2', '_goal_angle:=12')
        self.assertEqual(status, 0, output)
        bars = re.findall(r'(forward  |turn left): \|[^|]*\| (\S+) of (\S+) (\w+)', output)
        for name, total, unit in ('forward  ', *forward), ('turn left', *turn):
            shown = [float(number) for *bar, number, goal, of in bars if bar == [name] and (goal, of) == (total, unit)]
            # twice from 0 to the goal, with visible progress in between
            self.assertEqual(shown[0], 0, output)
            for number in max(shown), shown[-1]:
                # at the slowest speed, 0.2 rad/s, the robot turns by 0.01 rad between two poses
                self.assertAlmostEqual(number, float(total), delta=0.015, msg=output)
            self.assertEqual(sum(number > following for number, following in zip(shown, shown[1:])), 1, output)
            self.assertTrue([number for number in shown if 0 < number < float(total)], output)

    def test_by_time(self):
        self.check('timed_out_and_back.py', ('500', 'commands'), ('600', 'commands'))

    def test_by_odometry(self):
        self.check('odom_out_and_back.py', ('2.00', 'm'), ('12.00', 'rad'))


if __name__ == '__main__':
    support.main(TestProgressBar)
