#!/usr/bin/python3
"""Tests what the page offers for comparing runs: earlier paths, speeds that can be scrolled, a saved picture with its
numbers, reasons for disabled buttons; and a session by keyboard alone."""
import csv
import os
import re

from selenium.webdriver.common.action_chains import ActionChains
from selenium.webdriver.common.keys import Keys
import rospy
from std_srvs.srv import Empty

import support
from browser import Page, PageTest


class TestBrowserComparison(PageTest):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        rospy.set_param('/out_and_back/goal_distance', 0.2)
        rospy.set_param('/out_and_back/goal_angle', 0.5)

    def setUp(self):
        self.wait_for_rest()
        rospy.ServiceProxy('/arbotix/reset', Empty)()
        support.wait_for(lambda: self.odom.position() == (0, 0), 'the reset')
        self.page = Page(self.driver, self.url)     # without the runs of the test before

    def wait_for_rest(self):
        """Wait until the robot is at rest, apart from the noise of its encoders."""
        def check():
            twist = self.odom.next().twist.twist
            return abs(twist.linear.x) < 0.01 and abs(twist.angular.z) < 0.05
        support.wait_for(check, 'the robot to rest')

    def count(self, selector):
        """Return the number of elements for a CSS selector."""
        return len(self.driver.find_elements('css selector', selector))

    def press(self, key):
        """Press and release a key."""
        ActionChains(self.driver).send_keys(key).perform()

    def go_to(self, name):
        """Press Tab until the element with this id or method has the focus."""
        def focused():
            self.press(Keys.TAB)
            return self.driver.execute_script(
                'const {id, dataset} = document.activeElement; return [id, dataset.method].includes(arguments[0])',
                name)
        support.wait_for(focused, f'the focus on {name}')

    def test_earlier_runs_stay_and_can_be_hidden(self):
        for number, method in enumerate(('timed', 'odom'), 1):
            self.page.run(method)
            self.page.wait_for_text('run-state', 'finished')
            self.page.click('#reset')
            support.wait_for(lambda: self.count('.earlier path') == number, 'the path of the run')
        rows = self.driver.find_elements('css selector', '#runs tbody tr')
        for row, name in zip(rows, ('1 timed', '2 with odometry')):
            self.assertRegex(row.text, rf'^{name} low_ply_carpet, seed 7 \d\.\d{{3}} -?\d+\.\d$')
        self.assertEqual(len(rows), 2)
        self.page.click('#earlier input')
        self.assertEqual(self.count('.earlier path'), 1)
        self.assertEqual(self.page.find('.earlier g').get_attribute('data-run'), 'with odometry')

    def choose(self, name, value):
        """Choose a value in the page, as soon as this is possible."""
        def chosen():
            return self.driver.execute_script("""
                const input = document.querySelector(`#choices [name=${arguments[0]}]`);
                if (!input || input.disabled) { return false; }
                input.value = arguments[1];
                input.onchange();
                return true""", name, value)
        support.wait_for(chosen, f'{name} to be enabled')

    def test_another_floor_for_a_shorter_distance(self):
        self.addCleanup(rospy.set_param, '/out_and_back/goal_distance', 0.2)
        for surface, seed in ('hard_floor', '42'), ('low_ply_carpet', '7'):
            self.choose('surface', surface)
            self.page.wait_for_text('facts', surface)
            self.choose('seed', seed)
            self.page.wait_for_text('facts', rf'Seed\s+{seed}\b')
        self.choose('distance', '0,35')
        support.wait_for(lambda: rospy.get_param('/out_and_back/goal_distance') == 0.35, 'the parameter')
        self.choose('seed', '1.5')
        self.page.wait_for_text('notice', 'Refused: seed: expected')

    def test_how_far_the_robot_has_missed_its_start(self):
        self.page.run('timed')
        self.page.wait_for_text('headline', r'^Timed: missed the start by \d\.\d\d m and \d+°$')
        _, _, heading, distance = self.page.row('table-now', 'truth')
        meters, degrees = re.findall(r'[\d.]+', self.page.text('headline'))
        self.assertAlmostEqual(float(meters), distance, delta=0.0056)
        self.assertAlmostEqual(float(degrees), abs(heading), delta=0.56)
        self.page.click('#reset')
        self.page.wait_for_text('headline', '^$')
        row = self.page.find('#runs tbody tr').text.split()
        self.assertEqual([float(each) for each in row[-2:]], [distance, heading])

    def test_the_speeds_can_be_scrolled_back(self):
        self.page.run('timed')
        self.page.wait_for_text('run-state', 'finished')
        self.page.find('#window').send_keys('2 s')
        self.driver.execute_script('const end = document.getElementById("end"); end.value = 3; end.oninput()')
        support.wait_for(lambda: '3 s' in self.page.text('linear'), 'the seconds 1 to 3')
        shown = self.page.find('#linear .commanded').get_attribute('d')
        self.odom.next()
        self.assertEqual(self.page.find('#linear .commanded').get_attribute('d'), shown)

    def test_missing_odometry_leaves_a_gap(self):
        self.page.run('timed')
        self.page.wait_for_text('run-state', 'finished')

        def gaps():
            return self.page.find('#linear .reported').get_attribute('d').count('M') - 1
        self.assertEqual(gaps(), 0)
        self.driver.execute_script(
            'const {reported} = rbx1.model.speeds; reported.push([reported[reported.length - 1][0] + 3, 0, 0])')
        support.wait_for(lambda: gaps() == 1, 'a gap')

    def test_a_saved_picture_has_its_numbers(self):
        for method in 'timed', 'odom':
            self.page.run(method)
            self.page.wait_for_text('run-state', ': finished')
        support.wait_for(lambda: self.driver.execute_script('return rbx1.model.status.seed') == '7', 'the seed')
        lines = [text for _, text in self.driver.execute_script('return rbx1.caption()')]
        self.assertEqual(lines[:2], ['with odometry, low_ply_carpet, seed 7', 'Earlier runs (timed): 1'])
        ends = {source: self.page.row('table-now', source)[:2] for source in ('truth', 'odometry')}
        for line, (source, (x, y)) in zip(lines[2:], ends.items()):
            self.assertTrue(line.startswith(f'{source}: x {x:.3f} m, y {y:.3f} m'), line)
        self.page.click('#save')
        name = support.wait_for(lambda: [each for each in os.listdir(self.folder.name) if each.endswith('.csv')],
                                'a file')
        with open(os.path.join(self.folder.name, name[0]), encoding='utf-8') as file:
            rows = list(csv.DictReader(file))
        self.assertEqual({row['run']: row['method'] for row in rows}, {'1': 'timed', '2': 'with odometry'})
        for source, end in ends.items():
            row = [each for each in rows if each['source'] == source and each['run'] == '2'][-1]
            self.assertEqual((row['surface'], row['seed']), ('low_ply_carpet', '7'))
            for name, value in zip('xy', end):      # the points of a path are at most 2 cm apart
                self.assertAlmostEqual(float(row[name]), value, delta=0.021)

    def test_why_a_button_is_disabled(self):
        support.wait_for(lambda: self.page.find('.run[data-method=timed]').is_enabled(), 'a base')
        self.assertFalse(self.page.find('.run[data-method=ekf]').is_enabled())
        self.assertIn('needs the filter', self.page.text('why'))

    def test_a_session_by_keyboard_alone_and_with_reduced_motion(self):
        self.driver.execute_cdp_cmd('Emulation.setEmulatedMedia', {
            'features': [{'name': 'prefers-reduced-motion', 'value': 'reduce'}]})
        self.go_to('timed')
        self.press(Keys.ENTER)
        self.page.wait_for_text('run-state', 'Running: timed')
        support.wait_for(lambda: self.odom.position()[0] > 0.05, 'the run')
        self.assertEqual(self.driver.execute_script('return document.getAnimations().length'), 0)
        self.press(Keys.ESCAPE)
        self.page.wait_for_text('run-state', 'The robot was stationary')
        self.go_to('reset')
        self.press(Keys.SPACE)
        support.wait_for(lambda: self.odom.position() == (0, 0), 'the reset')
        support.wait_for(lambda: '1 timed, stopped' in self.page.text('earlier'), 'the path of the run')
        self.go_to('hand')
        self.press(Keys.ENTER)

        def moved():
            if self.page.find('#hand').get_attribute('aria-pressed') == 'false':    # a busy machine is late
                self.press(Keys.ENTER)
            self.page.key('keyDown', 'ArrowUp')
            return self.odom.position()[0] > 0.05
        support.wait_for(moved, 'the robot to drive')
        self.page.key('keyUp', 'ArrowUp')
        self.wait_for_rest()
        self.go_to('large')
        self.press(Keys.ENTER)
        self.assertFalse(self.page.find('#drive').is_displayed())
        self.assertTrue(self.page.find('#stop').is_displayed())


if __name__ == '__main__':
    support.main(TestBrowserComparison)
