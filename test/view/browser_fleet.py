#!/usr/bin/python3
"""The page with two robots: both are on one floor, and a click selects whose runs, keys and Stop are meant."""
import signal
import tempfile

import rospy

import support
from browser import Page, start_chromium, start_view


class TestBrowserFleet(support.Case):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.odometry = {name: support.Watch(f'/{name}/odom', support.Odometry) for name in ('robot1', 'robot2')}
        view, url = start_view('_robots:=2')
        self.addCleanup(view.wait)
        self.addCleanup(view.signal, signal.SIGTERM)
        driver = start_chromium(folder.name)
        self.addCleanup(driver.quit)
        self.page = Page(driver, url)

    def x(self, name):
        """Return x in the latest odometry of a robot, m."""
        return self.odometry[name].next().pose.pose.position.x

    def test_a_click_selects_a_robot(self):
        page = self.page
        page.wait_for_text('stop', 'Stop robot1')
        support.wait_for(lambda: page.driver.find_elements('css selector', '.other .robot'), 'the other robot')
        page.find('#robots a:nth-child(2)').click()
        page.wait_for_text('stop', 'Stop robot2')
        rospy.set_param('/robot2/out_and_back/goal_distance', 0.2)
        page.run('timed')
        support.wait_for(lambda: self.x('robot2') > 0.1, 'robot2 to drive')
        self.assertEqual(self.x('robot1'), 0)
        page.click('#stop')
        page.wait_for_text('run-state', 'The robot was stationary')
        # the robot on the floor, too
        page.driver.execute_script('document.querySelector(".other").dispatchEvent(new Event("click"))')
        page.wait_for_text('stop', 'Stop robot1')
        page.run('odom')
        support.wait_for(lambda: self.x('robot1') > 0.1, 'robot1 to drive')
        page.click('#stop')
        page.wait_for_text('run-state', 'The robot was stationary')
        self.assertEqual(page.console_errors(), [])


if __name__ == '__main__':
    support.main(TestBrowserFleet)
