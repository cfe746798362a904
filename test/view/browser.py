"""Drives a headless Chromium that shows the page of the web view."""
import json
import os
import re
import signal
import tempfile

from selenium import webdriver
from selenium.webdriver.chrome.options import Options

import support

# no sandbox: it does not work as root or in a container
ARGUMENTS = ('--headless=new', '--no-sandbox', '--disable-gpu', '--disable-dev-shm-usage', '--window-size=1300,950',
             '--disable-background-networking', '--no-first-run')
# records whether an element receives a click
RECORD = '''rbx1.clicked = false;
arguments[0].addEventListener('click', () => { rbx1.clicked = true; }, {once: true})'''
KEYS = {'ArrowUp': 38, 'ArrowLeft': 37, 'Escape': 27, ' ': 32, 'a': 65}   # key codes


def start_chromium(downloads):
    """Start Chromium; return its WebDriver. downloads: the directory for files that the page saves."""
    options = Options()
    options.binary_location = '/usr/bin/chromium'
    for argument in ARGUMENTS:
        options.add_argument(argument)
    # 1: as if a user had answered that the page may save several files
    options.add_experimental_option('prefs', {'download.default_directory': downloads,
                                              'profile.default_content_setting_values.automatic_downloads': 1})
    options.set_capability('goog:loggingPrefs', {'browser': 'ALL'})
    try:
        from selenium.webdriver.chrome.service import Service
        driver = webdriver.Chrome(service=Service('/usr/bin/chromedriver'), options=options)
    except TypeError:       # selenium 3, in Debian 11
        driver = webdriver.Chrome(executable_path='/usr/bin/chromedriver', options=options)
    driver.set_page_load_timeout(support.LIMIT)
    return driver


class Page:
    """The page of the web view in a browser."""

    def __init__(self, driver, url, connected='Connected'):
        """connected: how the text about the connection begins."""
        self.driver = driver
        driver.get('about:blank')   # a URL that differs only after the # would not be loaded
        driver.get(url)
        support.wait_for(lambda: self.text('connection').startswith(connected), 'a connection')

    def find(self, selector):
        """Return the element for a CSS selector."""
        return self.driver.find_element('css selector', selector)

    def text(self, name):
        """Return the text of the element with this id."""
        return self.find('#' + name).text

    def wait_for_text(self, name, pattern):
        """Wait until the text of an element matches a regular expression."""
        support.wait_for(lambda: re.search(pattern, self.text(name)), f'{pattern} in #{name}: {self.text(name)}')

    def click(self, selector):
        """Click on an element, as soon as it is enabled. Just after a reset, the page disables its buttons until the
        next odometry. A button that is disabled between a check and the click does not receive the click."""
        def clicked():
            element = self.find(selector)
            self.driver.execute_script(RECORD, element)
            element.click()
            return self.driver.execute_script('return rbx1.clicked')
        support.wait_for(clicked, f'{selector} to be enabled')

    def run(self, method):
        """Start a run. On a busy machine, the node may refuse the request because it is too old, or the page may ask
        whether the robot may move, because its ground truth is late."""
        def answered():
            text = self.text('notice')
            asks = self.find('#confirm').is_displayed()
            if asks:
                self.click('#confirm button')
            if asks or 'more than 2 s old' in text:
                self.click(f'.run[data-method={method}]')
                return False
            return text or self.text('run-state').startswith('Running')
        self.click(f'.run[data-method={method}]')
        support.wait_for(answered, f'an answer to the request of a run: {method}')

    def reset(self):
        """Put the robot back at its start, and wait until a new run has begun. On a busy machine, the node may refuse
        the request because it is too old."""
        def begun():
            if 'more than 2 s old' in self.text('notice'):
                self.click('#reset')
            return self.driver.execute_script('return rbx1.model.epoch') != epoch
        epoch = self.driver.execute_script('return rbx1.model.epoch')
        self.click('#reset')
        support.wait_for(begun, 'the reset')

    def robot(self, source):
        """Return where the page draws a robot: x, y (m), heading (degrees)."""
        transform = self.find(f'.robot.{source}').get_attribute('transform')
        return [float(each) for each in re.findall(r'-?\d+\.?\d*(?:e[-+]?\d+)?', transform)]

    def row(self, table, source):
        """Return the numbers in a row of a table: x, y (m), heading (degrees), distance from the start (m)."""
        cells = self.driver.find_elements('css selector', f'#{table} tbody tr')
        text = next(each.text for each in cells if each.text.startswith(source))
        return [float(each) for each in text.split()[1:]]

    def key(self, kind, key):
        """Press a key (keyDown), which remains pressed, or release it (keyUp)."""
        self.driver.execute_cdp_cmd('Input.dispatchKeyEvent', {
            'type': kind, 'key': key, 'code': key, 'windowsVirtualKeyCode': KEYS[key]})

    def send(self, **message):
        """Send a message to the node, as a user can do from the console of the browser."""
        self.driver.execute_script('rbx1.drive.connection.send(arguments[0])', message)

    def picture(self, path):
        """Save a screenshot."""
        self.driver.save_screenshot(path)

    def console_errors(self):
        """Return the errors and warnings that the browser has logged."""
        return [json.dumps(entry) for entry in self.driver.get_log('browser')
                if entry['level'] in ('SEVERE', 'WARNING')]


class PageTest(support.Case):
    """Tests of the page in Chromium, with a base that is running.

    If the environment variable RBX1_PICTURE_DIR is set, the screenshots are saved in that directory.
    """

    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.folder = tempfile.TemporaryDirectory()      # for files that the page saves
        cls.odom = support.OdomWatch()
        cls.view, cls.url = start_view()
        cls.driver = start_chromium(cls.folder.name)

    @classmethod
    def tearDownClass(cls):
        cls.driver.quit()
        cls.view.signal(signal.SIGTERM)
        assert cls.view.wait() == 0, cls.view.output
        cls.folder.cleanup()

    def tearDown(self):
        folder = os.environ.get('RBX1_PICTURE_DIR')
        if folder:
            self.page.picture(os.path.join(folder, f'{self.id().rpartition(".")[2]}.png'))
        self.assertEqual(self.page.console_errors(), [])


def start_view(*arguments):
    """Start the node; return its Process and the address that it prints."""
    view = support.Process('rosrun', 'rbx1_nav', 'web_view.py', '_port:=0', *arguments)
    return view, view.wait_for_line(r'Open (http://\S+)').group(1)
