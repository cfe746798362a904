#!/usr/bin/python3
"""Another process changes the rate of the port: the node restores it, and reports a last stop without confirmation."""
import signal
import subprocess

from driven import DrivenRobot
import support


class TestCreateRate(support.Case):
    def test_a_rate_that_was_changed(self):
        for robot_type in 'create', 'create2':
            robot = DrivenRobot(self, robot_type)
            robot.wait_for_motion()
            subprocess.run(['stty', '-F', robot.link, '9600', 'sane'], check=False)   # 1 if the node was faster
            robot.node.wait_for_line('%s: another process has changed the rate to 9600 baud: expected %d; restored'
                                     % (robot.link, robot.model.baud))
            robot.wait_for_status('Stationary')
            robot.commander.send(0.0, 0.0)
            robot.wait_for_motion()
            # immediately before the exit: the stop also needs the right rate
            subprocess.run(['stty', '-F', robot.link, '9600'], check=False)
            count = len(robot.received())
            robot.node.signal(signal.SIGTERM)
            self.assertEqual(robot.node.wait(), 0, robot.node.output)
            robot.wait_for_stop(count)
            robot.end()

    def test_a_stop_that_is_not_confirmed(self):
        robot = DrivenRobot(self, 'create2')
        robot.wait_for_motion()
        robot.switch('silence', True)
        robot.node.signal(signal.SIGTERM)
        self.assertEqual(robot.node.wait(), 1, robot.node.output)
        self.assertIn('The robot has not confirmed that it stopped. If it is still moving, stop it by hand',
                      robot.node.output)
        self.assertTrue(robot.moving)


if __name__ == '__main__':
    support.main(TestCreateRate)
