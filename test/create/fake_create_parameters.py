#!/usr/bin/python3
"""Parameters of fake_create.py: valid ones have an effect, an invalid one stops the node with a one-line message."""
import rospy

from emulated import EmulatedRobot
from rbx1_nav.extras.create.protocol import SAFE, command, drive_direct, encode_frame
import support


class TestParameters(support.Case):
    def test_good_parameters(self):
        robot = EmulatedRobot(self, 'create', baud=19200, mode_plus_one=True, drops_fractions=True, gyro_stuck=700)
        robot.open(19200)
        robot.send(command('start'), command('safe'), drive_direct(65, -65))
        self.assertEqual(robot.read(35), {'mode': SAFE + 1})
        support.wait_for(lambda: support.yaw(robot.truth.next()) > 0.5, 'the robot to turn')
        self.assertEqual(robot.read(33), {'analog_input': 700})
        # 15 ms at 28.6 degrees/s are less than a degree
        robot.send(command('stream', 1, 20))
        frame = encode_frame(robot.model, [20], {'angle': 0})
        robot.port.read_until(frame)
        self.assertEqual(robot.port.read(6 * 50), 50 * frame)
        robot.end()

    def test_bad_parameters(self):
        for params, expected in [
                (7, ': 7: expected a mapping'),
                ({'robot_type': 'roomba'}, "robot_type: 'roomba': expected one of create, create2"),
                ({'robot_type': 2}, 'robot_type: 2: expected one of create, create2'),
                ({'robot_type': ['create']}, "robot_type: ['create']: expected one of create, create2"),
                ({'baud': 19201}, 'baud: 19201: expected one of 300, 600, 1200'),
                ({'baud': True}, 'baud: True: expected one of 300, 600, 1200'),
                ({'mode_plus_one': 'yes'}, "mode_plus_one: 'yes': expected true or false"),
                ({'drops_fractions': 1}, 'drops_fractions: 1: expected true or false'),
                ({'gyro_stuck': 1024}, 'gyro_stuck: 1024: expected a count from -1 to 1023'),
                ({'link': 7}, 'link: 7: expected a path'),
                ({'link': '/no/such/folder/port'}, 'link: /no/such/folder/port: No such file or directory: expected'),
                ({'link': '/etc/hostname'}, 'link: /etc/hostname: exists, and is not a link: expected'),
                ({'surface': 'sand'}, f"surface: 'sand': expected one of {support.surfaces()}"),
                ({'seed': -1}, 'seed: -1: expected random, or an integer'),
                ({'charge': 3}, 'charge: 3: expected a number from 0 to 2'),
                ({'corruption': 'some'}, "corruption: 'some': expected a number from 0 to 1"),
                ({'wheel_base': 0}, 'wheel_base: 0: expected a factor from 0.1 to 10'),
                ({'gyro_measurement_range': 0}, 'gyro_measurement_range: 0: expected a number from 1')]:
            rospy.set_param('/fake_create', params)
            process = support.Process('rosrun', 'rbx1_nav', 'fake_create.py')
            self.assertEqual(process.wait(), 1, process.output)
            errors = [line for line in process.lines if '[FATAL]' in line]
            self.assertEqual(len(errors), 1, process.output)
            self.assertIn(f'/fake_create{expected}' if expected[0] == ':' else f'/fake_create/{expected}', errors[0])
            self.assertNotIn('Traceback', process.output)
            rospy.delete_param('/fake_create')


if __name__ == '__main__':
    support.main(TestParameters)
