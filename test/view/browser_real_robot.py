#!/usr/bin/python3
"""Tests that a real robot moves only after confirmation, which both the page and the node require."""
import signal
import tempfile

import support
from browser import Page, start_chromium, start_view

SPEED = 0.2     # m/s


class TestBrowserRealRobot(support.Case):
    def setUp(self):
        self.odom = support.OdomWatch()
        self.view, url = start_view()
        self.addCleanup(self.view.kill)
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.driver = start_chromium(folder.name)
        self.addCleanup(self.driver.quit)
        self.page = Page(self.driver, url)
        self.page.wait_for_text('facts', 'real')

    def allow_a_run(self):
        """Start a run, and confirm it."""
        self.page.click('.run[data-method=timed]')
        self.page.click('#confirm-move')

    def moves(self):
        """Return whether the robot moves. On a busy machine, the node may refuse the request because it is too old."""
        if 'more than 2 s old' in self.page.text('notice'):
            self.allow_a_run()
        return self.odom.last.twist.twist.linear.x == SPEED

    def test_it_asks(self):
        page = self.page
        # requests without confirmation are rejected
        for message in (dict(type='run', method='timed'), dict(type='hand', on=True)):
            self.driver.execute_script('document.getElementById("notice").textContent = ""')
            page.send(**message)
            page.wait_for_text('notice', 'Refused: a real robot')
        self.assertFalse(page.find('#reset').is_enabled())

        # Cancel
        page.click('.run[data-method=timed]')
        page.wait_for_text('confirm-title', 'This robot is real')
        page.wait_for_text('confirm-text', '1.5 m of free floor')
        page.click('#confirm button[value=cancel]')
        support.wait_for(lambda: not page.find('#confirm').is_displayed(), 'the dialog to close')
        self.assertEqual(page.text('run-state'), '')

        # Escape
        page.click('#hand')
        page.wait_for_text('confirm-text', 'arrow keys')
        page.key('keyDown', 'Escape')
        page.key('keyUp', 'Escape')
        support.wait_for(lambda: not page.find('#confirm').is_displayed(), 'the dialog to close')
        self.assertEqual(page.find('#hand').get_attribute('aria-pressed'), 'false')
        self.assertEqual(self.odom.position(), (0, 0))

        # Allow motion
        self.allow_a_run()
        support.wait_for(self.moves, 'the robot to move')
        page.click('#stop')
        self.odom.wait_for_twist(0.0)
        page.wait_for_text('run-state', 'The robot was stationary')
        self.assertEqual(page.console_errors(), [])
        self.view.signal(signal.SIGINT)
        self.assertEqual(self.view.wait(), 0, self.view.output)


if __name__ == '__main__':
    support.main(TestBrowserRealRobot)
