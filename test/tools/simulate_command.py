#!/usr/bin/python3
"""simulate.py at the command line: numbers, a picture, and one line for an invalid argument."""
import os
import re
import tempfile
import unittest

import numpy
from PIL import Image

import support


def simulate(*arguments):
    """Run it; returns the exit status and the output."""
    process = support.Process('rosrun', 'rbx1_nav', 'simulate.py', *arguments)
    try:
        return process.wait(), process.output
    finally:
        process.kill()


class TestSimulateCommand(unittest.TestCase):
    def test_three_methods_and_a_picture(self):
        with tempfile.TemporaryDirectory() as folder:
            picture = os.path.join(folder, 'methods.png')
            status, output = simulate('--surface', 'low_ply_carpet', '--runs', '3', '--plot', picture)
            self.assertEqual(status, 0, output)
            pixels = numpy.asarray(Image.open(picture).convert('RGB')).astype(int)
        rows = re.findall(r'^(timed|odom|ekf) +truth.* ([\d.]+) \+- [\d.]+$', output, re.MULTILINE)
        self.assertEqual([method for method, _ in rows], ['timed', 'odom', 'ekf'], output)
        by_time, by_odometry, by_both = (float(distance) for _, distance in rows)
        self.assertTrue(by_time > by_odometry > by_both, output)
        # three panels side by side, each with paths in blue and an end in red
        for panel in numpy.array_split(pixels[:len(pixels) // 2], 3, axis=1):
            red, green, blue = (panel[..., i] for i in range(3))
            self.assertGreater(((blue > 150) & (red < 120)).sum(), 50)
            self.assertGreater(((red > 150) & (green < 60) & (blue < 60)).sum(), 50)

    def test_one_method_on_the_ideal_surface(self):
        status, output = simulate('--method', 'timed', '--runs', '1')
        self.assertEqual(status, 0, output)
        # 157 ticks are a little less than pi seconds: 1.6 mm to the left, and 0.18 degrees short
        self.assertRegex(output, r'timed +truth +0\.000 \+- 0\.000 +0\.002 \+- 0\.000 +-0\.18 \+- +0\.00 +0\.002')
        self.assertNotIn('ekf', output)

    def test_invalid_arguments(self):
        for arguments, status, text in [
                (['--surface', 'sand'], 1, "'sand': expected one of hard_floor, ideal, low_ply_carpet"),
                (['--method', 'luck'], 2, 'luck'), (['--runs', '0'], 2, '--runs: 0: expected'),
                (['--plot', 'picture.doc'], 2, '--plot: picture.doc: expected'),
                (['--plot', '/'], 2, '--plot: /: expected'),
                (['--config', '/dev/null'], 1, '/dev/null: configuration: None: expected'),
                (['--seed', '-1'], 1, 'seed: -1: expected'), (['--config', '/nowhere.yaml'], 1, '/nowhere.yaml'),
                (['--plot', '/nowhere/picture.png'], 2, '--plot: /nowhere/picture.png: expected')]:
            actual, output = simulate(*arguments)
            self.assertEqual(actual, status, output)
            self.assertIn(text, output.splitlines()[-1])
            self.assertNotIn('Traceback', output)


if __name__ == '__main__':
    support.main('simulate_command', TestSimulateCommand)
