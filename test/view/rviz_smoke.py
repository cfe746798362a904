#!/usr/bin/python3
"""What a reader sees: starts RViz with sim.rviz on a virtual display, runs the exercise, and reads the screen.

Keeps its pictures where the environment variable RBX1_PICTURE_DIR says, if it is set.
"""
import copy
import os
import re
import subprocess
import tempfile
import time
import unittest

import numpy
import rospkg
import rospy
import rostest
import yaml
from PIL import ImageGrab
from rosgraph_msgs.msg import Log

PACKAGE = 'rbx1_nav'
WAIT = 120      # s that a machine under load may take for what takes 5; nothing here measures speed

# as RViz 1.14 paints the names of its displays in the Displays panel
NAME_OK, NAME_WARN, NAME_ERROR = (40, 120, 197), (192, 128, 0), (192, 32, 32)
MARKS = (255, 128, 13)      # the robot's orange marks, from its URDF

# An arrow's shaft, 0.02 m wide, covers 620 pixels of the 0.16 m between the circles of a sector, and 390 of each 0.1 m
# of the line. Less than half of one arrow is not an arrow.
ARROW = 260


def load(path):
    """A .rviz file, as dictionaries."""
    with open(path) as file:
        return yaml.safe_load(file)


def display(config, name):
    """The display of that name."""
    return next(each for each in config['Visualization Manager']['Displays'] if each['Name'] == name)


def colour(text):
    """'255; 25; 0' as numbers."""
    return tuple(int(each) for each in text.split(';'))


def painted(pixels, wanted):
    """Where the pixels have exactly this colour."""
    return (pixels == wanted).all(axis=-1)


def lit(pixels, wanted):
    """Where the pixels have this colour in more or less light. The arrows' red and the marks' orange are 100 apart."""
    light = pixels.max(axis=-1, keepdims=True)
    return (abs(pixels - numpy.array(wanted) * light / 255) < 30).all(axis=-1) & (light[..., 0] > 100)


class Picture:
    """A screenshot of RViz, and what is on it."""

    def __init__(self, screenshot, config):
        manager = config['Visualization Manager']
        pixels = numpy.asarray(screenshot).astype(int)

        # the 3D view is where the background is; what lies left of it is the Displays panel
        ground = painted(pixels, colour(manager['Global Options']['Background Color']))
        columns, rows = numpy.flatnonzero(ground.mean(axis=0) > 0.3), numpy.flatnonzero(ground.mean(axis=1) > 0.3)
        self.opened = bool(columns.size and rows.size)
        if not self.opened:
            return
        left, right, top, bottom = columns[0], columns[-1] + 1, rows[0], rows[-1] + 1
        panel, view = pixels[:, :left], pixels[top:bottom, left:right]

        self.fine, self.warnings, self.errors = (int(painted(panel, each).sum())
                                                 for each in (NAME_OK, NAME_WARN, NAME_ERROR))
        # the odom frame's metres at the middle of every pixel; TopDownOrtho's Scale is in pixels per metre
        look = manager['Views']['Current']
        row, column = numpy.indices(view.shape[:2]) + 0.5
        self.x = look['X'] + (column - view.shape[1] / 2) / look['Scale']
        self.y = look['Y'] - (row - view.shape[0] / 2) / look['Scale']
        self.marks = lit(view, MARKS)
        self.arrows = {each['Name']: lit(view, colour(each['Shape']['Color']))
                       for each in manager['Displays'] if each['Class'] == 'rviz/Odometry'}
        self.red = self.arrows['Odometry (red)']
        # a solid base is white; a ghost lets the background (48) and the arrows (0 in some channel) shine through
        self.white = view.min(axis=-1) > 200
        self.ghost = (view.min(axis=-1) > 54) & ~self.white

    @property
    def status(self):
        """In words, for people."""
        if not self.opened:
            return 'RViz has no window yet'
        return ('pixels in the Displays panel: %d of names in order, %d of warnings, %d of errors; %d of the robot'
                % (self.fine, self.warnings, self.errors, self.robot()))

    @property
    def ready(self):
        """All is well, and the robot stands at the origin, facing x."""
        # of 1460 pixels that should be there, a robot that faces the other way shows 510
        return self.opened and self.fine > 0 and not self.warnings and not self.errors and self.robot() > 1000

    def robot(self):
        """Pixels of the marks on the robot's front half, where it is at home; they reach 0.18 m ahead of its middle."""
        return int((self.marks & (numpy.hypot(self.x, self.y) < 0.2) & (self.x > -0.05)).sum())

    def star(self, centre, start):
        """Arrow pixels in eight sectors of 20 degrees of a half-star about (centre, 0), from start (degrees) on.

        Between circles of 0.20 m, just outside the robot, and 0.36 m, just short of the tips.
        """
        distance = numpy.hypot(self.x - centre, self.y)
        direction = numpy.degrees(numpy.arctan2(self.y, self.x - centre)) % 360
        ring = self.red & (distance > 0.20) & (distance < 0.36)
        return [int((ring & (direction >= each) & (direction < each + 20)).sum())
                for each in range(start, start + 160, 20)]

    def line(self):
        """Arrow pixels in five pieces of 0.1 m between the stars, from 0.4 m, the tip of the very first arrow, on."""
        red = self.red & (abs(self.y) < 0.03)
        return [int((red & (self.x >= each / 10) & (self.x < (each + 1) / 10)).sum()) for each in range(4, 9)]

    def drawn(self):
        """Arrow pixels of all that the exercise draws: two turns to the left, and the way between."""
        return {'half-star at 1 m': self.star(1, 10), 'half-star at the start': self.star(0, 190), 'line': self.line()}

    def blank(self):
        """Arrow pixels where it draws nothing: the other halves."""
        return {'right of 1 m': self.star(1, 190), 'left of the start': self.star(0, 10)}


class RvizTest(unittest.TestCase):
    """Each test gets a display and an RViz of its own."""

    FILE = 'sim.rviz'

    def setUp(self):
        self.path = rospkg.RosPack().get_path(PACKAGE)
        self.config = load(os.path.join(self.path, 'rviz', self.FILE))
        scratch = tempfile.TemporaryDirectory()
        self.addCleanup(scratch.cleanup)
        self.scratch = scratch.name
        self.pictures = os.environ.get('RBX1_PICTURE_DIR') or self.scratch
        os.makedirs(self.pictures, exist_ok=True)
        self.rosout = []
        rosout = rospy.Subscriber('/rosout', Log, self.on_log)
        self.addCleanup(rosout.unregister)
        self.start_display()

    def on_log(self, message):
        """Collect what RViz reports."""
        if message.name.startswith('/rviz') and message.level >= Log.ERROR:
            self.rosout.append(message.msg)

    def start(self, command, **options):
        """A process that ends with the test."""
        process = subprocess.Popen(command, stdin=subprocess.DEVNULL, **options)

        def end():
            process.terminate()
            try:
                process.wait(10)
            except subprocess.TimeoutExpired:
                process.kill()
                process.wait()
        self.addCleanup(end)
        return process

    def start_display(self):
        """An X server on a display number that it finds free itself."""
        ours, its = os.pipe()
        log = open(os.path.join(self.scratch, 'xvfb'), 'w')
        self.addCleanup(log.close)
        # noreset: or it would start anew whenever a screenshot is its last client
        self.start(['Xvfb', '-displayfd', str(its), '-screen', '0', '1280x800x24', '+extension', 'GLX',
                    '-nolisten', 'tcp', '-noreset'], pass_fds=[its], stdout=log, stderr=log)
        os.close(its)
        with open(ours) as answer:
            self.display = f':{answer.readline().strip()}'
        self.assertNotEqual(self.display, ':', 'Xvfb does not start')

    def start_rviz(self, path):
        """RViz as the tutorial starts it, in a home of its own, so that nobody's settings matter."""
        self.console = os.path.join(self.scratch, 'console')
        log = open(self.console, 'w')
        self.addCleanup(log.close)
        env = dict(os.environ, DISPLAY=self.display, HOME=self.scratch, XDG_RUNTIME_DIR=self.scratch,
                   LIBGL_ALWAYS_SOFTWARE='1', QT_X11_NO_MITSHM='1', QT_QPA_PLATFORM='xcb')
        self.rviz = self.start(['rosrun', 'rviz', 'rviz', '-d', path], env=env, stdout=log, stderr=log)

    def console_errors(self):
        """Lines that rosconsole marks so; what libraries of RViz print besides is not its report."""
        with open(self.console, errors='replace') as file:
            return [line for line in file if re.search(r'\[\s*(ERROR|FATAL)\]', line)]

    def wait_for(self, what, condition):
        """Look at the screen until the condition on the Picture holds. Returns the Picture."""
        deadline = time.monotonic() + WAIT
        while True:
            self.assertIsNone(self.rviz.poll(), 'RViz has ended')
            screenshot = ImageGrab.grab(xdisplay=self.display)
            picture = Picture(screenshot, self.config)
            if picture.opened and condition(picture):
                break
            if time.monotonic() > deadline:
                screenshot.save(os.path.join(self.pictures, 'failed.png'))
                self.fail('%s: not seen. %s. Arrows: %s. Errors: %s%s' % (
                    what, picture.status, picture.opened and picture.drawn(), self.console_errors(), self.rosout))
            time.sleep(0.5)
        screenshot.save(os.path.join(self.pictures, f'{what}.png'))
        return picture


class RvizSmoke(RvizTest):
    """The picture of the ideal run."""

    def test_arrows_of_the_exercise(self):
        """No display in trouble, no error reported; no arrows before the run, and two half-stars and a line after."""
        self.start_rviz(os.path.join(self.path, 'sim.rviz'))
        before = self.wait_for('before', lambda picture: picture.ready)
        for where, pixels in before.drawn().items():
            self.assertEqual(sum(pixels), 0, f'arrows before the run: {where}')

        subprocess.run(['rosrun', PACKAGE, 'timed_out_and_back.py'], check=True, timeout=WAIT)
        after = self.wait_for('after', lambda picture: picture.ready and all(
            min(pixels) > ARROW for pixels in picture.drawn().values()))

        for where, pixels in after.blank().items():
            self.assertEqual(sum(pixels), 0, f'arrows where none belong: {where}')
        self.assertEqual(self.console_errors(), [])
        self.assertEqual(self.rosout, [])

    def test_trouble_is_seen(self):
        """The other test can fail: a copy of the file with two mistakes in it shows up in all three places."""
        config = copy.deepcopy(self.config)
        display(config, 'Robot by odometry')['Robot Description'] = 'no_such_parameter'
        config['Visualization Manager']['Displays'].append({'Class': 'rviz/NoSuchDisplay', 'Name': 'No such display'})
        path = os.path.join(self.scratch, 'broken.rviz')
        with open(path, 'w') as file:
            yaml.safe_dump(config, file)

        self.start_rviz(path)
        # red names, and blue ones besides
        seen = self.wait_for('trouble', lambda picture: picture.errors and picture.fine and self.rosout)
        self.assertFalse(seen.ready)
        self.assertNotEqual(self.console_errors(), [])


if __name__ == '__main__':
    rospy.init_node('rviz_smoke')
    rostest.rosrun(PACKAGE, 'rviz_smoke', RvizSmoke)
