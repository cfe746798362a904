#!/usr/bin/python3
"""Tests the first screen of the page on the screens of a classroom, without a robot: the floor, Stop, the methods and
the result are on it, and nothing is cut. The page of the teacher has thirty seats on a projector."""
from collections import namedtuple
import os
import re
import tempfile
import time

from rbx1_nav.extras.web.access import Access
from rbx1_nav.extras.web.connections import Connections
from rbx1_nav.extras.web.seat_list import SeatList
from rbx1_nav.extras.web.server import PageServer
from rbx1_nav.extras.web.state import PageState, PoseAndSpeed
from rbx1_nav.node import resources

from ports import free_port
import support
from browser import Page, start_chromium

SURFACE = 'the_long_pile_carpet_of_the_gymnasium_of_our_school'
WIDE, NARROW = ('#stop', '#floor', '.runs', '#headline'), ('#stop', '#floor-box', '.runs', '#headline')
# width, height, whether it is a touch screen, what is on the first screen
SCREENS = [(1920, 1080, False, WIDE), (1300, 950, False, WIDE), (1024, 768, False, WIDE), (390, 844, True, WIDE),
           (844, 390, True, WIDE), (320, 640, False, NARROW), (320, 256, False, ('#stop',))]
Seat = namedtuple('Seat', 'number web_port token')
PROJECTORS = [(1920, 1080), (1024, 768)]
# the edges of an element, and the edges of the screen that the page can show without scrolling
EDGES = 'const {left, top, right, bottom} = document.querySelector(arguments[0]).getBoundingClientRect(); ' \
        'return [left, top, right, bottom]'
# the parts of the page whose text is wider than they are
CUT = '''return [...document.querySelectorAll('button, th, td, dt, dd, p, h1, h2, label')].filter(
  each => each.offsetParent && each.scrollWidth > each.clientWidth + 1 && getComputedStyle(each).display !== 'inline')
  .map(each => each.id || each.textContent)'''


class NoControls:
    """A view of a robot that nobody can drive."""

    speeds = 0.2, 1.0

    def answers(self):
        return {}

    def leave(self, browser):
        pass


def finished_run():
    """Return the state after a run."""
    state = PageState()
    now = time.monotonic()
    state.set_status(title='Out and back', robots=[''], spacing=1, base='/arbotix', simulated=True, can_reset=True,
                     surface=SURFACE, seed='4294967295', simulated_time=True, started='with odometry and gyro',
                     outcome='')
    state.move('odometry', PoseAndSpeed(0.0, (0.0, 0.0, 0.0), 0.0, 0.0), now)
    state.command(0.2, 0.7, '/out_and_back', now)
    for speed in (18.5, 0.1, -0.3), (19.5, 0.2, -0.5):
        state.move('odometry', PoseAndSpeed(speed[0], (-0.3, 0.2, -1.1), *speed[1:]), now)
    for source, (x, y) in dict(truth=(0.3, 0.4), odometry=(-0.3, 0.2), estimate=(0.31, 0.35)).items():
        state.move(source, PoseAndSpeed(20.0, (x, y, -1.1), 0.0, 0.0), now)
    state.command(0.0, 0.0, '/out_and_back', now)
    state.set_status(outcome='finished')
    return state


class TestBrowserLayout(support.Case):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.folder = tempfile.TemporaryDirectory()
        state = finished_run()
        connections = Connections(state, NoControls(), Access('token', 'code'), time.monotonic)
        state.tick = lambda now: None       # the poses do not time out
        folder, teacher_port = resources.path('web'), free_port()
        cls.server = PageServer(folder, {'/socket': connections}, 'localhost', 0, teacher_port=teacher_port)
        seats = SeatList(Access('token', 'code'), [Seat(number, cls.server.port, 'token') for number in range(1, 31)])
        cls.teacher = PageServer(folder, {'/socket': seats}, 'localhost', teacher_port, 'seats.html', [cls.server.port])
        cls.server.start()
        cls.teacher.start()
        cls.driver = start_chromium(cls.folder.name)
        cls.page = Page(cls.driver, f'http://localhost:{cls.server.port}/#code')
        cls.page.wait_for_text('headline', r'missed the start by 0\.50 m and 63°')

    @classmethod
    def tearDownClass(cls):
        cls.driver.quit()
        cls.server.stop()
        cls.teacher.stop()
        cls.folder.cleanup()

    def show(self, width, height, touch=False):
        """Show the page on a screen of this size, pixels, and return what is wrong there for every size."""
        self.driver.execute_cdp_cmd('Emulation.setDeviceMetricsOverride', {
            'width': width, 'height': height, 'deviceScaleFactor': 1, 'mobile': touch})
        self.driver.execute_cdp_cmd('Emulation.setTouchEmulationEnabled', {'enabled': touch})
        self.driver.execute_script('scrollTo(0, 0)')
        self.assertEqual(self.driver.execute_script(CUT), [], f'{width} x {height}: cut')
        scrolled, shown = self.driver.execute_script(
            'const {scrollWidth, clientWidth} = document.documentElement; return [scrollWidth, clientWidth]')
        self.assertLessEqual(scrolled, shown, f'{width} x {height}: scrolls to the side')
        if os.environ.get('RBX1_PICTURE_DIR'):
            name = '_'.join(self.driver.execute_script('return [document.title, document.documentElement.lang]'))
            self.page.picture(os.path.join(os.environ['RBX1_PICTURE_DIR'], f'{name}_{width}x{height}.png'))

    def test_the_first_screen(self):
        for width, height, touch, parts in SCREENS:
            self.show(width, height, touch)
            for part in parts:
                left, top, right, bottom = self.driver.execute_script(EDGES, part)
                with self.subTest(screen=(width, height), part=part):
                    self.assertTrue(0 <= left < right <= width and 0 <= top < bottom, (left, top, right, bottom))
                    # the floor may continue below Stop, which covers the lower edge of a phone
                    self.assertLessEqual(bottom if part != '#floor-box' else top + 150, height)
            self.assertEqual(self.page.find('#zoom-in').is_displayed(), not touch)

    def test_other_languages(self):
        address = f'http://localhost:{self.server.port}/'
        self.addCleanup(self.driver.get, address)
        for language, title, headline in (
                ('zh', '往返运动', '用里程计和陀螺仪：离起点 0.50 m，航向差 63°'),
                ('zh-TW', '往返運動', '用里程計和陀螺儀：離起點 0.50 m，航向差 63°'),
                ('de', 'Out and back', 'With odometry and gyro: missed the start by 0.50 m and 63°')):
            self.driver.get(f'{address}?lang={language}')
            self.page.wait_for_text('headline', re.escape(headline))
            self.assertEqual((self.driver.title, self.page.text('title')), (title, title))
            self.show(1300, 950)
            self.show(390, 844, True)

    def values(self, plot):
        """Return the numbers beside the cursor of a plot by their names; the time has none."""
        texts = self.driver.execute_script(
            'return [...document.querySelectorAll(arguments[0])].map(each => each.textContent)', f'#{plot} .value')
        pairs = [re.fullmatch(r'(.*?) ?(-?[\d.]+)( s)?', each).groups() for each in texts]
        return {name: float(number) for name, number, _ in pairs}

    def test_the_cursor_of_the_plots(self):
        self.show(1300, 950)
        self.page.find('#angular').location_once_scrolled_into_view
        left, top, right, bottom = self.driver.execute_script(EDGES, '#linear')
        # 19 s in the plot of 30 s, without its margins; between the samples at 18.5 s and 19.5 s
        x, pixel = left + 42 + 19 / 30 * (right - left - 50), 30 / (right - left - 50)
        self.driver.execute_cdp_cmd('Input.dispatchMouseEvent', {
            'type': 'mouseMoved', 'x': x, 'y': (top + bottom) / 2})
        support.wait_for(lambda: self.values('angular'), 'the values')
        for plot, expected, slope in ('linear', {'': 19, 'commanded': 0.2, 'reported by the wheels': 0.15}, 0.1), (
                'angular', {'': 19, 'commanded': 0.7, 'reported by the wheels': -0.4}, 0.2):
            values = self.values(plot)
            self.assertEqual(set(values), set(expected))
            for name, value in expected.items():    # a pixel, and the rounding of the text
                self.assertAlmostEqual(values[name], value, delta=(slope if name else 1) * pixel + 0.006)
        self.driver.execute_cdp_cmd('Input.dispatchMouseEvent', {'type': 'mouseMoved', 'x': 5, 'y': 5})
        support.wait_for(lambda: not self.values('linear'), 'no values')
        self.driver.execute_script("document.getElementById('angular').focus()")
        for _ in range(100 - 66):       # hundredths of the width, from its right edge
            self.page.key('keyDown', 'ArrowLeft')
        support.wait_for(lambda: self.values('linear').get('') == 19.8, 'the values at 19.8 s')
        self.assertEqual(self.page.find('#linear').get_attribute('aria-valuetext'),
                         '19.80 s, commanded 0.200, reported by the wheels 0.080')
        self.driver.execute_script("document.getElementById('angular').blur()")
        support.wait_for(lambda: not self.values('linear'), 'no values')

    def test_a_projector_cuts_nothing(self):
        self.page.click('#large')
        self.addCleanup(self.page.click, '#large')
        for width, height in PROJECTORS:
            self.show(width, height)
            self.assertLessEqual(self.driver.execute_script('return document.documentElement.scrollHeight'), height)
            sizes = [float(self.page.find(each).value_of_css_property('font-size')[:-2])
                     for each in ('#stop', '#facts')]
            self.assertGreater(*sizes)

    def test_thirty_seats_on_a_projector(self):
        self.addCleanup(self.driver.get, self.driver.current_url)
        page = Page(self.driver, f'http://localhost:{self.teacher.port}/#code', '30 of 30 seats connected')
        last, result = '.seat:nth-child(30)', r'missed the start by 0\.50 m and 63°'
        support.wait_for(lambda: re.search(result, page.find(f'{last} .state').text), result)
        for width, height, touch in (1920, 1080, False), (390, 844, True):
            self.show(width, height, touch)
            self.assertEqual(len(self.driver.find_elements('css selector', '.seat .robot.truth')), 30)
            if not touch:
                left, top, right, bottom = self.driver.execute_script(EDGES, last)
                self.assertTrue(right <= width and bottom <= height, (right, bottom))
                self.assertGreater(bottom - top, 180)


if __name__ == '__main__':
    support.main(TestBrowserLayout)
