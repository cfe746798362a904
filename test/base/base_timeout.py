#!/usr/bin/python3
"""A command stays in force for exactly the timeout; then the base stops."""
import support


class TestBaseTimeout(support.Case):
    def test_a_command_lasts_for_the_timeout(self):
        odom = support.OdomWatch()
        support.Commander().send(0.2)
        odom.wait_for_twist(0.2, since=0)
        odom.wait_for_twist(0.0)
        # 0.2 m/s for the 1.0 s of the default timeout
        x, y = odom.position()
        self.assertAlmostEqual(x, 0.2, delta=support.MICROMETRE)
        self.assertAlmostEqual(y, 0.0, delta=support.MICROMETRE)


if __name__ == '__main__':
    support.main(TestBaseTimeout)
