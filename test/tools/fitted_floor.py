#!/usr/bin/python3
"""A surface fitted to recorded runs agrees with the floor, and the exercise simulated on it with the runs."""
import os
import re
import signal
import tempfile

import rosgraph
import rospkg
import rospy
import yaml

from rbx1_nav.base.surfaces import load_surface
from rbx1_nav.extras.fitting.recording import relative
import support

TOPICS = '/cmd_vel', '/odom', '/imu/data', '/ground_truth'


class TestFittedFloor(support.Case):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = folder.name
        self.truth = support.Watch('/ground_truth', support.Odometry)
        support.wait_for(lambda: self.truth.last, '/ground_truth')

    def run_process(self, process):
        """Wait for a Process that must succeed; return its output."""
        self.assertEqual(process.wait(), 0, process.output)
        return process.output

    def record(self, name):
        """Drive the exercise and record it; return the path of the bag."""
        path = os.path.join(self.folder, name)
        recorder = support.Process('rosbag', 'record', '-O', path, *TOPICS)
        master = rosgraph.Master(rospy.get_name())
        support.wait_for(lambda: all(any(node.startswith('/record') for node in nodes)
                                     for topic, nodes in master.getSystemState()[1] if topic in TOPICS), 'the recorder')
        start = self.truth.next()
        self.run_process(support.out_and_back())
        # a second at standstill, also for the gyro
        end = self.truth.next().header.stamp + rospy.Duration(3)
        support.wait_for(lambda: self.truth.last.header.stamp > end, 'the robot at rest')
        recorder.signal(signal.SIGINT)
        recorder.wait()
        self.assertTrue(os.path.isfile(path), recorder.output)
        return path, relative(support.pose(start), support.pose(self.truth.last))

    def test_runs_are_recorded_and_fitted_and_simulated(self):
        bags, ends = zip(*(self.record('run%d.bag' % number) for number in (1, 2)))
        real = sum(ends) / len(ends)
        surface = os.path.join(self.folder, 'my_floor.yaml')
        picture = os.path.join(self.folder, 'fit.png')
        output = self.run_process(support.Process(
            'rosrun', 'rbx1_nav', 'fit_surface.py', *bags, '--truth', '/ground_truth', '--start', 'hard_floor',
            '--output', surface, '--plot', picture))
        self.assertNotIn('Warning: odometry', output)
        self.assertGreater(os.path.getsize(picture), 10000)

        folder = os.path.join(rospkg.RosPack().get_path('rbx1_nav'), 'config', 'surfaces')
        floor, start = (load_surface(name, folder) for name in ('low_ply_carpet', 'hard_floor'))
        fitted = load_surface(surface, folder)
        with open(surface) as file:
            text = file.read()
        self.assertEqual(set(yaml.safe_load(text)), set(fitted._fields[1:]))
        for key, tolerance in (
                # the carpet's noise over 4 m and 4 half turns: three standard deviations, 0.022 and 0.024
                ('slip_straight', 0.07), ('slip_turning', 0.07),
                # the recorder stamps commands when they arrive, in simulated time, which is twice as fast
                ('drag_straight', 0.003), ('drag_turning', 0.003)):
            self.assertAlmostEqual(getattr(fitted, key), getattr(floor, key), delta=tolerance, msg=f"{key}\n{output}")
            self.assertRegex(text, rf'\n{key}: .*fitted, \+- ')
        for key in 'heading_noise_turning', 'heading_noise_straight', 'distance_noise':     # within a factor of 3
            self.assertTrue(1 / 3 < getattr(fitted, key) / getattr(floor, key) < 3, f"{key}\n{output}")
        self.assertGreater(abs(start.drag_turning - floor.drag_turning), 0.01)      # so the start values would fail
        self.assertRegex(text, r'\nticks_meter: 4100 .*not fitted')

        output = self.run_process(support.Process('rosrun', 'rbx1_nav', 'simulate.py', '--surface', surface, '--method',
                                                  'timed', '--runs', '20'))
        x, y = map(float, re.search(r'timed +truth +(\S+) \+- \S+ +(\S+) \+-', output).groups())
        # mean of the two runs to which slip was fitted; the end pose of the ideal robot is the start, half a meter away
        self.assertLess(abs(x - real[0]), 0.20, (real, output))
        self.assertLess(abs(y - real[1]), 0.20, (real, output))
        self.assertGreater(real[1], 0.3)


if __name__ == '__main__':
    support.main(TestFittedFloor)
