#!/usr/bin/python3
"""A silent line is detected, and a last stop that is not confirmed is reported."""
import signal

from driven import DrivenRobot
import support


class TestCreateSilence(support.Case):
    def test_a_stop_that_is_not_confirmed(self):
        robot = DrivenRobot(self, 'create2')
        with robot.driving():
            robot.switch('silence', True)
        robot.node.wait_for_line('The robot has stopped responding')
        robot.wait_for_status('The robot does not answer')
        robot.node.signal(signal.SIGTERM)
        self.assertEqual(robot.node.wait(), 1, robot.node.output)
        self.assertIn('The robot has not confirmed that it stopped. If it is still moving, stop it by hand',
                      robot.node.output)
        self.assertTrue(robot.moving)


if __name__ == '__main__':
    support.main(TestCreateSilence)
