#!/usr/bin/python3
"""pycreate2, an independent driver, drives the emulated Create 2 and reads sensors that match the simulation.

The test installs pycreate2 from the Python package index into a temporary folder. If the index cannot be reached, the
test is skipped.
"""
from math import pi
import subprocess
import sys
import tempfile
import unittest

from emulated import EmulatedRobot
import support

VERSION = '0.8.0'
COUNTS = 508.8 / (pi * 0.072)   # encoder counts per meter


def import_pycreate2(folder):
    """Install pycreate2 into a folder and import it. Raises SkipTest."""
    try:
        subprocess.run([sys.executable, '-m', 'pip', 'install', '--quiet', '--no-deps', '--retries', '0',
                        '--target', folder, f'pycreate2=={VERSION}'],
                       check=True, capture_output=True, text=True, timeout=120)
    except (OSError, subprocess.SubprocessError) as error:
        text = (getattr(error, 'stderr', None) or str(error)).strip().splitlines()[-1]
        print(f'pycreate2 cannot be installed, so it is not tried: {text}', file=sys.stderr)
        raise unittest.SkipTest(f'pycreate2 cannot be installed: {text}')
    sys.path.insert(0, folder)
    import pycreate2
    return pycreate2


class TestIndependentClient(support.Case):
    def test_pycreate2(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        pycreate2 = import_pycreate2(folder.name)
        robot = EmulatedRobot(self, 'create2')
        client = pycreate2.Create2(robot.link)
        client.SCI.ser.timeout = support.LIMIT
        client.start()
        self.assertEqual(client.get_sensors().open_interface_mode, 1)
        client.safe()
        sensors = client.get_sensors()
        self.assertEqual(sensors.open_interface_mode, 2)
        self.assertEqual((sensors.encoder_counts_left, sensors.encoder_counts_right), (0, 0))
        self.assertEqual(sensors.battery_charge, sensors.battery_capacity)

        client.drive_direct(200, 200)
        support.wait_for(lambda: robot.position > 0.3, 'the robot to drive')
        self.assertEqual(client.get_sensors().velocity_right, 200)
        client.drive_stop()
        support.wait_for(lambda: not robot.moving, 'the robot to stand')
        distance = client.get_sensors()
        x, y, yaw = support.pose(robot.truth.next())
        self.assertEqual((y, yaw), (0, 0))
        for counts in distance.encoder_counts_left, distance.encoder_counts_right:
            self.assertAlmostEqual(counts, x * COUNTS, delta=1)

        client.drive_direct(100, -100)
        support.wait_for(lambda: support.yaw(robot.truth.next()) > 1, 'the robot to turn')
        client.drive_stop()
        support.wait_for(lambda: not robot.moving, 'the robot to stand')
        sensors = client.get_sensors()
        turned = support.yaw(robot.truth.next())
        self.assertAlmostEqual(sensors.angle * pi / 180, turned, delta=pi / 180)     # whole degrees
        counts = sensors.encoder_counts_right - distance.encoder_counts_right
        self.assertAlmostEqual(counts, turned * 0.235 / 2 * COUNTS, delta=1)

        client.drive_pwm(51, 51)        # a fifth of 500 mm/s
        support.wait_for(lambda: robot.truth.next().twist.twist.linear.x == 0.1, 'the robot to drive by PWM')
        robot.switch('cliff', True)
        support.wait_for(lambda: client.get_sensors().open_interface_mode == 1, 'passive mode')
        self.assertTrue(client.get_sensors().cliff_front_left)
        robot.switch('cliff', False)
        client.full()
        client.createSong(1, (60, 255, 64, 255))
        client.playSong(1)
        robot.switch('bump', True)
        support.wait_for(lambda: client.get_sensors().bumps_wheeldrops.bump_left, 'a bump')

        client.SCI.ser.timeout = 1      # it requests more bytes than there are
        self.assertIn(b'r3_robot/tags/release-', client.reset())
        client.close()
        client.drive_stop = client.led = client.digit_led_ascii = client.stop = lambda *_: None    # for its __del__
        self.assertFalse(robot.moving)


if __name__ == '__main__':
    support.main(TestIndependentClient)
