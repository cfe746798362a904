#!/usr/bin/python3
"""The robot leaves safe mode: the node reports the cause, and takes control again only when the cause is removed."""
from driven import DrivenRobot
from rbx1_nav.extras.create.protocol import command
import support


class TestCreateSafety(support.Case):
    def test_safe_mode(self):
        robot = DrivenRobot(self, 'create2')
        for service, reason in (('drop_wheel', 'a wheel dropped'), ('cliff', 'a cliff')):
            robot.wait_for_motion()
            robot.switch(service, True)
            robot.drive(0.2, 0.0, lambda: not robot.moving, 'the robot to stop')
            robot.drive(0.2, 0.0, lambda why=reason: robot.status().message == f'Not driven: {why}', reason)
            robot.node.wait_for_line('it changed from safe to passive mode')
            count = len(robot.received())
            # commands do not change the mode
            self.assertFalse(robot.moving)
            robot.diagnostics.next()
            robot.diagnostics.next()
            self.assertNotIn(command('safe'), robot.commands_since(count))
            robot.switch(service, False)
            robot.wait_for_status('Stationary')
            robot.wait_for_mode('safe')
        robot.wait_for_motion()

        # on the dock the robot charges until a command to move arrives
        robot.switch('dock', True)
        robot.wait_for_status('Not driven: on the dock')
        robot.publish('charge', 0.15)
        robot.wait_for_status('charging', 'Battery')
        robot.switch('dock', False)
        robot.wait_for_status('Low: 15 %', 'Battery')
        robot.node.wait_for_line('Battery: Low: 15 %')
        robot.wait_for_status('Stationary')
        robot.publish('charge', 0.0)
        robot.wait_for_status('The robot does not answer')


if __name__ == '__main__':
    support.main(TestCreateSafety)
