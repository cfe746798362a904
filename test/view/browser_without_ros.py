#!/usr/bin/python3
"""Tests the page that script/page builds, in Chromium: its runs have the end poses of simulate.py, a script runs and
can be stopped, and the page works when its server has gone. RBX1_PAGE_SEEDS: number of seeds to compare, default 1."""
import math
import os
import re
import shutil
import signal
import subprocess
import tempfile
import unittest

from rbx1_nav.base.robot_parameters import load_robot
from rbx1_nav.base.surfaces import known_surfaces, load_surface
from rbx1_nav.exercise.methods import METHODS
from rbx1_nav.extras.many_runs.simulated_run import simulate
from rbx1_nav.node import resources

import support
from browser import Page, start_chromium

SCRIPT = os.path.join(os.path.dirname(os.path.realpath(__file__)), '..', '..', 'script', 'page')
# ends a run of the page's Python without the display
RUN = '''const [request, done] = arguments;
import('./connection.js').then(({Connection}) => Connection.instance.python.run(request)).then(
  frames => done(frames[frames.length - 1].poses), error => done(String(error)))'''
SET = '''arguments[0].value = arguments[1];
['input', 'change'].forEach(each => arguments[0].dispatchEvent(new Event(each)))'''
OWN = '''import rospy
from geometry_msgs.msg import Twist
rospy.init_node('own')
rospy.Publisher('cmd_vel', Twist).publish(Twist())
rospy.sleep(0.5)
rospy.Subscriber('odom', print)
'''
ELSEWHERE = '''import js
request = js.XMLHttpRequest.new()
request.open('GET', 'https://example.org/', False)
request.send()
'''


def printed(pose):
    """The digits that pose.py prints of a pose: x, y (m), heading (degrees)."""
    x, y, yaw = pose
    return f'{x:.3f} {y:.3f} {math.degrees(support.wrapped(yaw)):.1f}'


@unittest.skipUnless(shutil.which('npm'), 'npm is missing: the page without ROS was not tested')
class TestBrowserWithoutRos(support.Case):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.folder = tempfile.TemporaryDirectory()
        built = subprocess.run([SCRIPT, cls.folder.name], stderr=subprocess.PIPE, encoding='utf-8')
        if "'npm', 'pack'" in built.stderr:
            raise unittest.SkipTest(f'the page without ROS was not tested: {built.stderr.splitlines()[-1]}')
        cls.server = support.Process(SCRIPT, cls.folder.name, '--serve', '--port', '0')
        cls.driver = start_chromium(cls.folder.name)
        cls.page = Page(cls.driver, cls.server.wait_for_line(r'Open (http://\S+)').group(1))

    @classmethod
    def tearDownClass(cls):
        cls.driver.quit()
        cls.server.kill()
        cls.folder.cleanup()

    def tearDown(self):
        self.assertEqual(self.page.console_errors(), [])

    def set(self, name, value):
        """Set a field of the page."""
        self.driver.execute_script(SET, self.page.find(f'#{name}'), value)

    def choose(self, name, value):
        """Type the value of a choice."""
        field = f'[name={name}]'
        support.wait_for(lambda: self.page.find(field).is_enabled(), field)
        self.driver.execute_script(SET, self.page.find(field), value)

    def test_end_poses(self):
        self.driver.set_script_timeout(support.LIMIT)
        robot = load_robot(resources.path('config', 'turtlebot.yaml'))
        for surface in known_surfaces(resources.surfaces()):
            for method in METHODS:
                for seed in range(7, 7 + int(os.environ.get('RBX1_PAGE_SEEDS', 1))):
                    end = simulate(method, robot, load_surface(surface, resources.surfaces()), seed, filtered=True).end
                    poses = self.driver.execute_async_script(RUN, {
                        'method': method, 'surface': surface, 'seed': seed, 'parameters': {},
                        'text': '', 'stop': None, 'as_one_frame': True})
                    expected = {source: printed(getattr(end, source)) for source in ('truth', 'odometry', 'estimate')}
                    self.assertEqual({source: printed(pose) for source, pose in poses.items()}, expected)

    def test_script(self):
        self.set('pace', 1000)
        self.page.click('#run-script')
        self.page.wait_for_text('run-state', 'finished')
        # as in step 5 of the tutorial
        self.assertEqual(self.page.row('table-now', 'truth')[:3], [0.096, 0.482, -56.9])
        self.assertIn('Stopping the robot...', self.page.text('lines'))
        self.choose('distance', '0.5')
        self.page.click('#run-script')
        self.page.wait_for_text('table-now', 'script')
        support.wait_for(lambda: abs(self.page.row('table-now', 'truth')[0] - 0.096) > 0.002
                         and 'finished' in self.page.text('run-state'), 'another end')
        self.choose('distance', '9')
        self.page.wait_for_text('notice', 'distance: expected a number from 0.1 to 3')
        self.choose('distance', '1')
        self.set('text', OWN)
        self.page.click('#run-script')
        self.page.wait_for_text('lines', r'line 6: rospy\.Subscriber does not exist on this page')
        self.page.wait_for_text('run-state', 'failed; see the log')
        self.page.click('#restore')
        support.wait_for(lambda: 'OutAndBack' in self.page.find('#text').get_attribute('value'), 'the script')

    def test_script_reaches_no_other_address(self):
        self.set('text', ELSEWHERE)
        self.page.click('#run-script')
        self.page.wait_for_text('lines', 'line 4: JsException: NetworkError')
        self.page.click('#restore')
        errors = self.page.console_errors()
        self.assertTrue(errors)
        self.assertEqual([each for each in errors if 'Content Security Policy' not in each], [])

    def test_stop(self):
        self.set('pace', 5)
        self.page.click('#run-script')
        support.wait_for(lambda: self.driver.execute_script('return rbx1.model.time') > 1, 'a robot that moves')
        self.page.click('#stop')
        self.page.wait_for_text('run-state', 'The robot is stationary')
        self.page.wait_for_text('lines', 'Out-and-Back node terminated.')
        self.assertEqual(self.driver.execute_script('return rbx1.model.status.outcome'), 'stopped')

    def test_many_runs(self):
        self.page.click('#many')
        shown = 'return rbx1.model.earlier.filter(run => run.name === "timed").map(run => run.seed)'
        support.wait_for(lambda: len(self.driver.execute_script(shown)) >= 30, '30 runs')
        self.assertEqual(self.driver.execute_script(shown)[-30:], [str(seed) for seed in range(7, 37)])
        support.wait_for(lambda: re.match(r'timed, mean of 3\d runs low_ply_carpet 0\.4', self.page.find('.mean').text),
                         'the mean')
        self.assertEqual(self.page.find('[name=seed]').get_attribute('value'), '7')

    def test_without_its_server(self):
        """Named last: it stops the server."""
        controlled = 'return navigator.serviceWorker.ready.then(() => Boolean(navigator.serviceWorker.controller))'
        support.wait_for(lambda: self.driver.execute_script(controlled), 'the service worker')
        self.server.signal(signal.SIGINT)
        self.assertEqual(self.server.wait(), 130, self.server.output)
        self.driver.get(self.driver.current_url)
        self.page.wait_for_text('connection', 'Connected')
        self.page.run('timed')
        sources = self.driver.execute_script('return performance.getEntriesByType("resource").map(each => each.name)')
        self.assertEqual({re.match(r'\w+://([^/]*)', each).group(1) for each in sources},
                         {re.search(r'//([^/]*)', self.driver.current_url).group(1)})


if __name__ == '__main__':
    support.main(TestBrowserWithoutRos)
