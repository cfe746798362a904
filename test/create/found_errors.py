#!/usr/bin/python3
"""On an emulated Create with known errors, the calibration scripts find the factors that correct them.

usage: found_errors.py LINEAR ANGULAR GYRO --
"""
import math
import re
import sys

import support

WITHIN = 0.01       # relative error of the factor that the package guarantees


class TestFoundErrors(support.Case):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.truth = support.Watch('/ground_truth', support.Odometry)
        support.wait_for(lambda: cls.truth.last, '/ground_truth')

    def calibrate(self, script, line, measure):
        """Run a script; after `line`, enter the result of measure(true pose at the start, true pose at the end)."""
        for _ in range(support.ATTEMPTS):
            start = support.pose(self.truth.next())
            process = support.Process('rosrun', 'rbx1_nav', script)
            if support.LATE not in process.wait_for_line(f'{line}|{support.LATE}')[0]:
                break
        process.type(f'{measure(start, support.pose(self.truth.next())):.3f}')
        self.assertEqual(process.wait(), 0, process.output)
        return {key: float(value) for key, value in re.findall(r'^(\w+_correction): (\S+)$', process.output,
                                                               re.MULTILINE)}

    def check(self, found, expected):
        """Compare factors by name."""
        self.assertEqual(sorted(found), sorted(expected))
        for key, factor in expected.items():
            self.assertAlmostEqual(found[key] / factor, 1, delta=WITHIN, msg=key)

    def test_linear(self):
        found = self.calibrate('calibrate_linear.py', 'The odometry reports',
                               lambda start, end: math.dist(start[:2], end[:2]))
        self.check(found, {'odom_linear_scale_correction': float(sys.argv[1])})

    def test_angular(self):
        expected = dict(zip(('odom_angular_scale_correction', 'gyro_scale_correction'), map(float, sys.argv[2:4])))
        found = self.calibrate('calibrate_angular.py', 'The gyro reports',
                               lambda start, end: 360 + math.degrees(support.wrapped(end[2] - start[2])))
        self.check(found, expected)


if __name__ == '__main__':
    support.main(TestFoundErrors)
