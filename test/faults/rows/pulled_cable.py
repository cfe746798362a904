"""The cable of an emulated Create is pulled during a motion, and plugged in again."""
import time

import support
from driven import CHI_SQUARE, IDEAL, STOP, DrivenRobot

FAULT = "a Create's cable is pulled at a random moment of a motion, and plugged in again"
PROMISE = ('the node first sends a stop; the odometry includes the motion in between, and its covariance is '
           'consistent with the error')
FULL, SHORT = 50, 2
ROOT = ALONE = False


def pull(row, robot, seconds, gap, velocity):
    """One fault, in motion."""
    end = time.monotonic() + seconds
    robot.drive(*velocity, lambda: time.monotonic() > end and robot.moving, 'the robot to move')
    robot.switch('pull_cable', True)
    time.sleep(gap)
    count = len(robot.received())
    robot.switch('pull_cable', False)
    robot.wait_for_standstill()
    assert robot.wait_for_command(count)[1] == STOP, robot.commands_since(count)
    robot.wait_for_status('Stationary')
    error = robot.normalized_error()
    row.figure('normalized squared error', error)
    assert error < CHI_SQUARE, f'squared error {error:.1f} of {robot.error()}'


def run(row):
    """See FAULT. A robot of its own for each, so that the errors are independent."""
    row.roscore()
    support.init_node('faults')
    for index in range(row.times):
        robot_type = ('create', 'create2')[index % 2]
        seconds, gap = row.random.uniform(0.2, 2), row.random.uniform(0.1, 4)
        velocity = row.random.uniform(0.1, 0.3), row.random.choice([0.0, row.random.uniform(-1, 1)])
        with row.case('%s: cable pulled after %.3f s at %.3f m/s, %.3f rad/s for %.3f s'
                      % (robot_type, seconds, *velocity, gap)) as case:
            pull(row, DrivenRobot(case, robot_type, **IDEAL), seconds, gap, velocity)
    errors = row.figures.get('normalized squared error', [])
    if len(errors) > 10:
        with row.fault('the mean of the squared errors'):
            assert 0.5 < sum(errors) / len(errors) < 6, sum(errors) / len(errors)
