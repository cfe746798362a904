#!/usr/bin/python3
"""If a node hangs in motion, its guardian stops the robot. If the guardian dies, the node starts a new one."""
import os
import signal

from driven import DrivenRobot, guardian_of
import support


class TestCreateKilled(support.Case):
    def test_hang(self):
        robot = DrivenRobot(self, 'create2')
        robot.wait_for_motion()
        count = len(robot.received())
        pid = support.pid_of('/turtlebot_node')
        os.kill(pid, signal.SIGSTOP)
        robot.wait_for_stop(count)
        os.kill(pid, signal.SIGCONT)
        robot.wait_for_standstill()
        # a reply that has waited for the node shows the passive mode in which the guardian has left the robot
        robot.node.wait_for_line(r'(?s)(The robot answers again|Lost control of the robot).*in safe mode')
        robot.drive_again()

        # the node needs its guardian
        guardian = guardian_of(pid)
        os.kill(guardian, signal.SIGKILL)
        robot.node.wait_for_line('The guardian process died: starting a new one')
        support.wait_for(lambda: guardian_of(pid) not in (guardian, None), 'another guardian')
        robot.drive_again()
        count = len(robot.received())
        os.kill(pid, signal.SIGKILL)
        robot.wait_for_stop(count)


if __name__ == '__main__':
    support.main(TestCreateKilled)
