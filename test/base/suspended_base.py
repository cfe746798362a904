#!/usr/bin/python3
"""The timeout starts when the command arrives, even if the base process is suspended when the timeout expires."""
import os
import signal
import time

import support


class TestSuspendedBase(support.Case):
    def test_the_timeout_ends_while_the_base_is_suspended(self):
        odom = support.OdomWatch()
        base = support.pid_of('/arbotix')
        support.Commander().send(0.2)
        odom.wait_for_twist(0.2)
        self.addCleanup(os.kill, base, signal.SIGCONT)
        os.kill(base, signal.SIGSTOP)
        time.sleep(1.5)     # longer than the timeout of 1.0 s
        os.kill(base, signal.SIGCONT)
        odom.wait_for_twist(0.0)
        self.assertAlmostEqual(odom.position()[0], 0.2, delta=support.MICROMETRE)


if __name__ == '__main__':
    support.main(TestSuspendedBase)
