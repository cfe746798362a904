#!/usr/bin/python3
"""simulate.py rejects a picture that it cannot write before it starts the simulation."""
import os
import tempfile
import unittest

import support


class TestImpossiblePlot(unittest.TestCase):
    def test_plots(self):
        with tempfile.TemporaryDirectory() as folder:
            os.mkdir(os.path.join(folder, 'taken.png'))
            for path, expected in [
                    ('/proc/picture.png', 'expected a file that can be written: '),     # not even by a superuser
                    (os.path.join(folder, 'taken.png'), 'expected a file that can be written: Is a directory'),
                    ('', 'expected a file name with one of the extensions ')]:
                process = support.Process('rosrun', 'rbx1_nav', 'simulate.py', '--runs', '1', '--plot', path)
                self.addCleanup(process.kill)
                self.assertEqual(process.wait(), 2, process.output)
                self.assertIn(f'simulate.py: error: --plot: {path}: {expected}', process.lines[-1])
                self.assertNotIn('Runs', process.output)
            self.assertEqual(os.listdir(folder), ['taken.png'])


if __name__ == '__main__':
    support.main('impossible_plot', TestImpossiblePlot)
