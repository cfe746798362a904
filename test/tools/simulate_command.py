#!/usr/bin/python3
"""simulate.py on the command line prints numbers, writes a picture, and reports an invalid argument in one line."""
import os
import re
import tempfile

import numpy
from PIL import Image

from rbx1_nav.extras.many_runs.plots import TRUTH
import support


def simulate(*arguments):
    """Run simulate.py; return the exit status and the output."""
    process = support.Process('rosrun', 'rbx1_nav', 'simulate.py', *arguments)
    return process.wait(), process.output


class TestSimulateCommand(support.Case):
    def test_three_methods_and_a_picture(self):
        with tempfile.TemporaryDirectory() as folder:
            picture = os.path.join(folder, 'methods.png')
            status, output = simulate('--surface', 'low_ply_carpet', '--runs', '10', '--plot', picture)
            self.assertEqual(status, 0, output)
            pixels = numpy.asarray(Image.open(picture).convert('RGB')).astype(int)
        rows = re.findall(r'^(timed|odom|ekf) +truth.* ([\d.]+) \+- [\d.]+$', output, re.MULTILINE)
        self.assertEqual([method for method, _ in rows], ['timed', 'odom', 'ekf'], output)
        by_time, by_odometry, by_both = (float(distance) for _, distance in rows)
        self.assertTrue(by_time > by_odometry > by_both, output)
        # three panels side by side, each with pale paths and a solid arrow at an end pose, both blue
        solid = tuple(bytes.fromhex(TRUTH[1:]))
        for panel in numpy.array_split(pixels[:len(pixels) // 2], 3, axis=1):
            red, blue = panel[..., 0], panel[..., 2]
            self.assertGreater(((blue > 200) & (red > 100) & (red < 200)).sum(), 50)
            self.assertGreater((abs(panel - solid).max(axis=2) < 10).sum(), 50)

    def test_one_method_on_the_ideal_surface(self):
        status, output = simulate('--method', 'timed', '--runs', '1')
        self.assertEqual(status, 0, output)
        # 157 ticks are slightly shorter than pi seconds: 1.6 mm to the left, and 0.18 degrees short
        self.assertRegex(output, r'timed +truth +0\.000 \+- 0\.000 +0\.002 \+- 0\.000 +-0\.18 \+- +0\.00 +0\.002')
        self.assertNotIn('ekf', output)

    def test_a_picture_that_cannot_be_written(self):
        """It is rejected before the simulation starts."""
        with tempfile.TemporaryDirectory() as folder:
            os.mkdir(os.path.join(folder, 'taken.png'))
            for path, expected in [
                    ('/proc/picture.png', 'expected a file that can be written: '),     # not even by a superuser
                    (os.path.join(folder, 'taken.png'), 'expected a file that can be written: Is a directory')]:
                status, output = simulate('--runs', '1', '--plot', path)
                self.assertEqual(status, 2, output)
                self.assertIn(f'simulate.py: error: --plot: {path}: {expected}', output.splitlines()[-1])
                self.assertNotIn('Runs', output)
            self.assertEqual(os.listdir(folder), ['taken.png'])

    def test_invalid_arguments(self):
        for arguments, status, text in [
                (['--surface', 'sand'], 1, f"'sand': expected one of {support.surfaces()}"),
                (['--method', 'luck'], 2, 'luck'), (['--runs', '0'], 2, '--runs: 0: expected'),
                (['--animate', 'run.mp4'], 2,
                 '--animate: run.mp4: expected a file name with the extension .gif'),       # or .png
                (['--seed', '-1'], 2, '--seed: -1: expected an integer from 0 to 2147483548'),
                (['--config', '/dev/null'], 1, '/dev/null: configuration: None: expected')]:
            actual, output = simulate(*arguments)
            self.assertEqual(actual, status, output)
            self.assertIn(text, output.splitlines()[-1])
            self.assertNotIn('Traceback', output)


if __name__ == '__main__':
    support.main(TestSimulateCommand)
