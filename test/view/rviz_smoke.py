#!/usr/bin/python3
"""Tests what a reader sees: starts RViz with sim.rviz on a virtual display, runs the exercise, and checks screenshots.

If the environment variable RBX1_PICTURE_DIR is set, the screenshots are saved in that directory.
"""
from contextlib import ExitStack
import os
import re
import subprocess
import sys
import tempfile
import time

import numpy
import rospkg
import rospy
import yaml
from rosgraph_msgs.msg import Log

import support

sys.path.append(os.path.join(os.path.dirname(os.path.realpath(__file__)), '..'))
from pages.display import screenshot, virtual_display

PACKAGE = 'rbx1_nav'
FRAME_RATE = 4      # Hz: without a GPU, the 30 Hz of the files would use more than a core
WAIT = 120      # s; usually 5 s are enough, but the machine may be busy

# colors of the display names in the Displays panel of RViz 1.14
NAME_OK, NAME_WARN, NAME_ERROR = (40, 120, 197), (192, 128, 0), (192, 32, 32)
MARKS = (255, 128, 13)      # color of the orange marks in the URDF of the robot

# The shaft of an arrow is 0.02 m wide. It covers 620 pixels in a sector, which is 0.16 m long, and 390 pixels of each
# 0.1 m of the line. Fewer than 260 pixels do not count as an arrow.
ARROW = 260


def load(path):
    """Return the content of a .rviz file."""
    with open(path) as file:
        return yaml.safe_load(file)


def colour(text):
    """Convert a color such as '242; 16; 0' to numbers."""
    return tuple(int(each) for each in text.split(';'))


def painted(pixels, wanted):
    """Return where the pixels have exactly this color."""
    return (pixels == wanted).all(axis=-1)


def lit(pixels, wanted):
    """Return where the pixels have this color at any brightness. The red of the arrows and the orange of the marks
    differ by 100 in green."""
    light = pixels.max(axis=-1, keepdims=True) / max(wanted)
    return (abs(pixels - numpy.array(wanted) * light) < 30).all(axis=-1) & (light[..., 0] > 0.4)


class Picture:
    """A screenshot of RViz, and its analysis."""

    def __init__(self, screenshot, config):
        manager = config['Visualization Manager']
        pixels = numpy.asarray(screenshot).astype(int)

        # the 3D view has the background color; the Displays panel is to the left of it
        ground = painted(pixels, colour(manager['Global Options']['Background Color']))
        columns, rows = numpy.flatnonzero(ground.mean(axis=0) > 0.3), numpy.flatnonzero(ground.mean(axis=1) > 0.3)
        self.opened = bool(columns.size and rows.size)
        if not self.opened:
            return
        left, right, top, bottom = columns[0], columns[-1] + 1, rows[0], rows[-1] + 1
        panel, view = pixels[:, :left], pixels[top:bottom, left:right]

        self.fine, self.warnings, self.errors = (int(painted(panel, each).sum())
                                                 for each in (NAME_OK, NAME_WARN, NAME_ERROR))
        # coordinates in odom of the center of each pixel, m; the Scale of TopDownOrtho is in pixels per meter
        look = manager['Views']['Current']
        row, column = numpy.indices(view.shape[:2]) + 0.5
        self.x = look['X'] + (column - view.shape[1] / 2) / look['Scale']
        self.y = look['Y'] - (row - view.shape[0] / 2) / look['Scale']
        self.marks = lit(view, MARKS)
        self.arrows = {each['Name']: lit(view, colour(each['Shape']['Color']))
                       for each in manager['Displays'] if each['Class'] == 'rviz/Odometry'}
        self.red = self.arrows['Odometry (red)']
        # a solid base is white; a transparent one shows the background (48) and the arrows (0 in some channel)
        self.white = view.min(axis=-1) > 200
        self.ghost = (view.min(axis=-1) > 54) & ~self.white

    @property
    def status(self):
        """Describe the screenshot for an error message."""
        if not self.opened:
            return 'RViz has not opened its window'
        return ('pixels in the Displays panel: %d without problems, %d warnings, %d errors; pixels of the robot: %d'
                % (self.fine, self.warnings, self.errors, self.robot()))

    @property
    def ready(self):
        """Whether there are no warnings or errors, and the robot is at the origin, facing x."""
        # a robot that faces x shows 1460 pixels there; a robot that faces -x shows 510
        return self.opened and self.fine > 0 and not self.warnings and not self.errors and self.robot() > 1000

    def robot(self):
        """Return the orange pixels on the front half of a robot at the origin. Its marks extend to x = 0.18 m."""
        return int((self.marks & (numpy.hypot(self.x, self.y) < 0.2) & (self.x > -0.05)).sum())

    def star(self, centre, start):
        """Return the arrow pixels in eight sectors of 20 degrees around (centre, 0), the first at start (degrees).

        The sectors extend from 0.20 m, just outside the robot, to 0.36 m, just inside the tips of the arrows.
        """
        distance = numpy.hypot(self.x - centre, self.y)
        direction = numpy.degrees(numpy.arctan2(self.y, self.x - centre)) % 360
        ring = self.red & (distance > 0.20) & (distance < 0.36)
        return [int((ring & (direction >= each) & (direction < each + 20)).sum())
                for each in range(start, start + 160, 20)]

    def line(self):
        """Return the arrow pixels in each of five pieces of 0.1 m, from 0.4 m, the tip of the first arrow, to 0.9 m."""
        red = self.red & (abs(self.y) < 0.03)
        return [int((red & (self.x >= each / 10) & (self.x < (each + 1) / 10)).sum()) for each in range(4, 9)]

    def drawn(self):
        """Return the arrow pixels where the exercise draws arrows: two left turns, and the line between them."""
        return {'half-star at 1 m': self.star(1, 10), 'half-star at the start': self.star(0, 190), 'line': self.line()}

    def blank(self):
        """Return the arrow pixels where the exercise draws nothing: the other half of each star."""
        return {'right of 1 m': self.star(1, 190), 'left of the start': self.star(0, 10)}


class RvizTest(support.Case):
    """Each test starts its own X server and RViz."""

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
        screen = ExitStack()
        self.addCleanup(screen.close)
        self.display = screen.enter_context(virtual_display())

    def on_log(self, message):
        """Store the errors that RViz logs."""
        if message.name.startswith('/rviz') and message.level >= Log.ERROR:
            self.rosout.append(message.msg)

    def start(self, command, **options):
        """Start a process that is stopped at the end of the test."""
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

    def start_rviz(self, path):
        """Start RViz with a file, in an empty home directory, so that no user settings apply."""
        config = load(path)
        config['Visualization Manager']['Global Options']['Frame Rate'] = FRAME_RATE
        path = os.path.join(self.scratch, 'slow.rviz')
        with open(path, 'w') as file:
            yaml.safe_dump(config, file)
        self.console = os.path.join(self.scratch, 'console')
        log = open(self.console, 'w')
        self.addCleanup(log.close)
        env = dict(os.environ, DISPLAY=self.display, HOME=self.scratch, XDG_RUNTIME_DIR=self.scratch,
                   LIBGL_ALWAYS_SOFTWARE='1', QT_X11_NO_MITSHM='1', QT_QPA_PLATFORM='xcb')
        self.rviz = self.start(['rosrun', 'rviz', 'rviz', '-d', path], env=env, stdout=log, stderr=log)

    def console_errors(self):
        """Return the lines that rosconsole marks as errors, without the other output of libraries."""
        with open(self.console, errors='replace') as file:
            return [line for line in file if re.search(r'\[\s*(ERROR|FATAL)\]', line)]

    def wait_for(self, what, condition):
        """Take screenshots until the condition is true for a Picture; return that Picture."""
        deadline = time.monotonic() + WAIT
        while True:
            self.assertIsNone(self.rviz.poll(), 'RViz has exited')
            image = screenshot(self.display)
            picture = Picture(image, self.config)
            if picture.opened and condition(picture):
                break
            if time.monotonic() > deadline:
                image.save(os.path.join(self.pictures, 'failed.png'))
                self.fail('%s: not seen. %s. Arrows: %s. Errors: %s%s' % (
                    what, picture.status, picture.opened and picture.drawn(), self.console_errors(), self.rosout))
            time.sleep(0.5)
        image.save(os.path.join(self.pictures, f'{what}.png'))
        return picture


class RvizSmoke(RvizTest):
    """The arrows after a run on the ideal floor."""

    def test_arrows_of_the_exercise(self):
        """No display has an error; there are no arrows before the run, and two half-stars and a line after it."""
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


if __name__ == '__main__':
    support.main(RvizSmoke)
