#!/usr/bin/python3
"""Tests the page in Chromium: it shows the robot at the pose in /odom, runs and keys drive the robot, Stop stops it,
and the browser logs no errors."""
import math
import os
import re
import signal
import socket
import threading

from nav_msgs.msg import Odometry
import rospy

import support
from browser import Page, PageTest

SPEED = 0.2     # m/s, of the timed script


class Relay:
    """Passes connections on to a port. Its connections can go dead without an end, as when a router restarts."""

    def __init__(self, port):
        self.target = port
        self.server = socket.create_server(('127.0.0.1', 0))
        self.port = self.server.getsockname()[1]
        self.pairs = []
        threading.Thread(target=self._accept, daemon=True).start()

    def _accept(self):
        while True:
            try:
                near = self.server.accept()[0]
            except OSError:     # close()
                return
            pair = [near, socket.create_connection(('127.0.0.1', self.target))]
            self.pairs.append(pair)
            for source, sink in pair, pair[::-1]:
                threading.Thread(target=self._pass_on, args=(pair, source, sink), daemon=True).start()

    def _pass_on(self, pair, source, sink):
        try:
            for data in iter(lambda: source.recv(65536), b''):
                if pair not in self.pairs:
                    return
                sink.sendall(data)
            if pair in self.pairs:
                sink.shutdown(socket.SHUT_WR)
        except OSError:
            pass

    def break_connections(self):
        """From now on, the existing connections pass on neither data nor their end."""
        self.dead, self.pairs = self.pairs, []      # kept, since a socket that is deleted is closed

    def close(self):
        self.server.close()


class TestBrowserPage(PageTest):
    @classmethod
    def setUpClass(cls):
        # rosout collects the log of all nodes; roscore starts it, but rostest does not
        cls.rosout = support.Process('rosrun', 'rosout', 'rosout')
        super().setUpClass()
        cls.truth = support.Watch('/ground_truth', Odometry)

    @classmethod
    def tearDownClass(cls):
        super().tearDownClass()
        cls.rosout.kill()

    def setUp(self):
        self.page = Page(self.driver, self.url)
        self.page.click('#stop')
        self.page.wait_for_text('run-state', 'The robot was stationary')
        self.page.reset()
        support.wait_for(lambda: self.odom.position() == (0, 0), 'the reset')

    def hold(self, key, condition, what):
        """Hold an arrow key until a condition holds; it remains pressed. The keyboard repeats it, and like a user, this
        switches driving by hand on again if the connection was lost, as on a busy machine."""
        def check():
            if self.page.find('#hand').get_attribute('aria-pressed') == 'false':
                self.page.click('#hand')
            self.page.key('keyDown', key)
            return condition()
        support.wait_for(check, what)

    def drive_ahead(self, distance):
        """Hold the arrow key until the robot has driven this distance, m."""
        self.hold('ArrowUp', lambda: self.odom.position()[0] > distance, 'the robot to drive')

    def test_the_robot_is_where_odom_says(self):
        self.drive_ahead(0.1)
        self.hold('ArrowLeft', lambda: support.yaw(self.odom.last) > 0.5, 'the robot to turn')
        self.page.key('keyUp', 'ArrowUp')
        self.page.key('keyUp', 'ArrowLeft')
        self.odom.wait_for_twist(0.0)
        x, y, yaw = support.pose(self.odom.last)

        def shown():
            px, py, degrees = self.page.robot('odometry')
            # the resolution of a frame is 0.1 mm and 0.1 mrad
            return max(abs(px - x), abs(py - y), abs(math.radians(degrees) - yaw)) < 2e-4
        support.wait_for(shown, f'the robot at {x}, {y}, {yaw}')
        row = self.page.row('table-now', 'odometry')
        self.assertAlmostEqual(row[0], x, delta=0.00056)    # rounded to four decimals, and then to three
        self.assertAlmostEqual(row[1], y, delta=0.00056)
        self.assertTrue(self.page.find('path.path.odometry').get_attribute('d'))
        self.assertTrue(self.page.find('path.arrow.odometry').get_attribute('d'))
        self.assertTrue(self.page.find('#linear .reported').get_attribute('d'))

    def test_a_run_and_the_run_before(self):
        rospy.set_param('/out_and_back/goal_distance', 0.5)
        self.addCleanup(rospy.delete_param, '/out_and_back/goal_distance')
        begin = len(self.odom.messages)
        self.page.run('timed')
        self.page.wait_for_text('run-state', 'Running: timed')
        self.odom.wait_for_twist(0.0, 1.0, begin)
        self.page.wait_for_text('run-state', 'Timed: finished')
        for source, watch in ('truth', self.truth), ('odometry', self.odom):
            x, y, _ = support.pose(watch.last)
            row = self.page.row('table-now', source)
            self.assertAlmostEqual(row[0], x, delta=0.00056)    # rounded to four decimals, and then to three
            self.assertAlmostEqual(row[1], y, delta=0.00056)
        end = self.page.row('table-now', 'odometry')
        self.page.wait_for_text('lines', 'Done: commanded 1.00 m forward')
        self.page.click('#reset')
        support.wait_for(lambda: self.page.find('#earlier').is_displayed(), 'the list of earlier runs')
        self.page.wait_for_text('earlier', rf'1 timed ideal {end[3]:.3f} {end[2]:.1f}$')

    def test_stop_ends_a_run(self):
        self.page.run('odom')
        support.wait_for(lambda: self.odom.position()[0] > 0.05, 'the robot to drive')
        self.page.click('#stop')
        self.odom.wait_for_twist(0.0)
        self.page.wait_for_text('run-state', 'The robot was stationary')
        self.assertFalse(rospy.has_param('/out_and_back/odom_frame'), 'it would affect the next run in a terminal')
        self.assertLess(self.odom.position()[0], 0.9)   # before the end of the first leg

    def test_a_run_that_another_page_stops(self):
        self.page.run('odom')
        support.wait_for(lambda: self.odom.position()[0] > 0.05, 'the robot to drive')
        self.page.send(type='stop', number=1)       # this page does not know of it
        self.page.wait_for_text('run-state', 'With odometry: stopped, not from this page')

    def test_escape_stops_a_script_of_a_terminal(self):
        script = support.out_and_back()
        self.odom.wait_for_twist(SPEED)
        self.page.key('keyDown', 'Escape')
        self.page.key('keyUp', 'Escape')
        self.odom.wait_for_twist(0.0)
        self.assertEqual(script.wait(), 128 + signal.SIGTERM, script.output)    # as after `rosnode kill`
        self.assertNotIn('Done', script.output)

    def test_a_run_is_refused_while_a_script_of_a_terminal_drives(self):
        script = support.out_and_back()
        self.odom.wait_for_twist(SPEED)
        self.page.wait_for_text('run-state', 'Running: /out_and_back')
        self.assertFalse(self.page.find('.run').is_enabled())
        self.page.send(type='run', method='timed')
        self.page.wait_for_text('notice', '/out_and_back is driving the robot: stop it first')
        script.signal(signal.SIGINT)            # the script went on
        self.assertEqual(script.wait(), 128 + signal.SIGINT, script.output)

    def test_stop_ends_driving_by_hand(self):
        self.drive_ahead(0.05)
        self.page.click('#stop')
        self.odom.wait_for_twist(0.0)
        self.page.key('keyUp', 'ArrowUp')
        self.assertEqual(self.page.find('#hand').get_attribute('aria-pressed'), 'false')
        self.assertEqual(self.driver.find_elements('css selector', '.pad button.held'), [])

    def test_stop_is_repeated_until_it_is_answered(self):
        pid = support.pid_of('/web_view')
        self.addCleanup(os.kill, pid, signal.SIGCONT)
        os.kill(pid, signal.SIGSTOP)    # its sockets remain open
        self.page.wait_for_text('connection', 'No answer')
        self.assertEqual(self.page.find('#connection').get_attribute('class'), 'lost')
        self.assertFalse(self.page.find('.run[data-method=timed]').is_enabled())
        self.page.click('#stop')
        self.page.wait_for_text('notice', 'No answer: the robot may still be moving|Not connected: Stop did not reach')
        os.kill(pid, signal.SIGCONT)
        self.page.wait_for_text('run-state', r'Stopped\. The robot was stationary')
        support.wait_for(lambda: not self.page.find('#notice').is_displayed(), 'the alarm to disappear')
        self.page.wait_for_text('connection', 'Connected')

    def test_a_connection_that_is_dead_is_replaced(self):
        relay = Relay(int(re.search(r':(\d+)/', self.url).group(1)))
        self.addCleanup(relay.close)
        token = self.driver.execute_script('return localStorage.getItem("token")')
        url = re.sub(r':\d+/', f':{relay.port}/', self.url)
        Page(self.driver, url)      # for the browser, this is another site
        self.driver.execute_script('localStorage.setItem("token", arguments[0])', token)
        self.page = Page(self.driver, url)
        self.drive_ahead(0.05)
        relay.break_connections()
        self.page.click('#stop')
        self.page.wait_for_text('run-state', r'The robot was stationary')
        self.page.wait_for_text('connection', 'Connected')
        self.assertEqual(self.page.find('#notice').text, '')
        self.page.key('keyUp', 'ArrowUp')

    def test_a_key_that_was_held_while_the_page_was_frozen_must_be_pressed_again(self):
        self.drive_ahead(0.05)
        self.driver.execute_script('const end = performance.now() + 1000; while (performance.now() < end) {}')
        support.wait_for(lambda: not self.driver.find_elements('css selector', '.pad button.held'), 'the release')
        self.odom.wait_for_twist(0.0)
        self.page.key('keyUp', 'ArrowUp')

    def test_space_on_an_arrow_button_drives(self):
        def check():
            if self.page.find('#hand').get_attribute('aria-pressed') == 'false':
                self.page.click('#hand')
            self.driver.execute_script('document.querySelector(".pad button").focus()')
            self.page.key('keyDown', ' ')
            return self.odom.position()[0] > 0.05
        support.wait_for(check, 'the robot to drive')
        self.page.key('keyUp', ' ')
        self.odom.wait_for_twist(0.0)

    def test_a_letter_is_a_shortcut_only_while_the_floor_has_the_focus(self):
        def pressed_a():
            self.page.key('keyDown', 'a')
            self.page.key('keyUp', 'a')
            return self.page.find('#arrows').get_attribute('aria-pressed')
        self.assertEqual(pressed_a(), 'true')
        self.driver.execute_script('document.getElementById("floor").focus()')
        self.assertEqual(pressed_a(), 'false')

    def test_a_pose_far_away_is_only_a_number(self):
        publisher = rospy.Publisher('/odom_ekf', Odometry, queue_size=1)
        self.addCleanup(publisher.unregister)
        far = Odometry()
        far.pose.pose.position.x, far.pose.pose.orientation.w = 1e17, 1.0

        def shown():
            publisher.publish(far)
            return f'{1e17:.0f}' in self.page.text('table-now')
        support.wait_for(shown, 'the pose in the table')
        self.driver.execute_script(     # an earlier run that was never near the start
            'rbx1.model.earlier = [{number: 1, name: "far", points: [[1e17, 0, 0]], shown: true}];'
            'rbx1.floor.draw(rbx1.model)')
        self.assertFalse(self.driver.find_elements('css selector', '.earlier path'))
        self.page.click('#home')
        self.page.click('#stop')
        self.page.wait_for_text('run-state', 'The robot was stationary')

    def test_without_the_token_nothing_moves(self):
        token = self.driver.execute_script('return localStorage.getItem("token")')
        self.driver.execute_script('localStorage.clear()')
        self.addCleanup(self.driver.execute_script, 'localStorage.setItem("token", arguments[0])', token)
        self.page = Page(self.driver, self.url)
        self.page.wait_for_text('connection', 'watching only')
        self.page.wait_for_text('notice', 'has been used already')      # the address of the set-up
        for selector in '.run[data-method=timed]', '#reset', '#hand', '.pad button':
            support.wait_for(lambda: not self.page.find(selector).is_enabled(), f'{selector} to be disabled')
        for message in (dict(type='run', method='timed'), dict(type='hand', on=True), dict(type='drive', forward=1)):
            self.page.driver.execute_script('document.getElementById("notice").textContent = ""')
            self.page.send(**message)
            self.page.wait_for_text('notice', 'Refused: this page cannot drive the robot')
        self.assertEqual(self.odom.position(), (0, 0))
        self.assertTrue(self.page.find('#stop').is_enabled())

    def test_the_token_is_not_in_the_address_bar(self):
        self.assertNotIn('#', self.driver.current_url)
        self.assertNotIn(self.url.partition('#')[2], self.page.text('lines'))

    def test_an_address_for_another_browser(self):
        self.page.click('#invite')
        self.page.wait_for_text('notice', rf'drive: {self.url.partition("#")[0]}#\S{{20,}}$')
        address = self.page.text('notice').rpartition(' ')[2]
        tokens = []
        for connected in 'Connected$', 'Connected, watching only':      # the second use
            self.driver.execute_script('localStorage.clear()')
            self.page = Page(self.driver, address)
            self.page.wait_for_text('connection', connected)
            tokens.append(self.driver.execute_script('return localStorage.getItem("token")'))
        self.assertEqual(tokens[1], '')
        self.driver.execute_script('localStorage.setItem("token", arguments[0])', tokens[0])

    def test_the_picture_is_saved(self):
        self.drive_ahead(0.1)
        self.page.key('keyUp', 'ArrowUp')
        self.odom.wait_for_twist(0.0)

        def saved(kind):
            return [os.path.join(self.folder.name, name) for name in os.listdir(self.folder.name)
                    if name.endswith(kind)]
        self.page.click('#save')
        support.wait_for(lambda: saved('.csv') and saved('.png'), 'two files')
        with open(saved('.png')[0], 'rb') as file:
            self.assertEqual(file.read(8), b'\x89PNG\r\n\x1a\n')


if __name__ == '__main__':
    support.main(TestBrowserPage)
