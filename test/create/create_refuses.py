#!/usr/bin/python3
"""A script commands too high a speed, a wheel drops, or the cable is unplugged while it drives: it exits with 1 and the
reason, and the robot does not move again."""
from driven import DrivenRobot
import support


class TestCreateRefuses(support.Case):
    def drive_by_script(self, robot):
        """Start a script, and wait until it drives the robot."""
        script = support.out_and_back()
        support.wait_for(lambda: robot.moving, f'the script to drive: {script.output}')
        return script

    def check_refusal(self, script, reason):
        self.assertEqual(script.wait(), 1, script.output)
        self.assertRegex(script.output, r'\[ERROR\].*/cmd_vel: /turtlebot_node did not follow a command: ' + reason)

    def test_faster_than_its_wheels(self):
        DrivenRobot(self, 'create2')
        self.check_refusal(support.out_and_back('_linear_speed:=1'),
                           '1 m/s, 0 rad/s: expected at most 0.5 m/s at each wheel')

    def test_a_wheel_drop(self):
        robot = DrivenRobot(self, 'create2')
        script = self.drive_by_script(robot)
        robot.switch('drop_wheel', True)
        self.check_refusal(script, 'a wheel dropped')
        robot.wait_for_standstill()

    def test_a_cable_that_is_out(self):
        robot = DrivenRobot(self, 'create')
        script = self.drive_by_script(robot)
        robot.switch('pull_cable', True)
        self.check_refusal(script, 'the robot does not answer')
        robot.node.wait_for_line('Lost the serial connection')
        robot.wait_for_status('no such device')
        robot.switch('pull_cable', False)
        robot.wait_for_standstill()


if __name__ == '__main__':
    support.main(TestCreateRefuses)
