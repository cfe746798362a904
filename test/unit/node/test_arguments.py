"""Command-line arguments that rospy would silently ignore are found, and the intended parameter is suggested."""
import pytest

from rbx1_nav.node.private_parameters import find_problem

NAMES = ['rate', 'goal_distance', 'odom_frame', 'odom_used', 'imu_used', 'surface', 'sim']
EXPECTED = 'expected _parameter:=value or topic:=new_topic'


@pytest.mark.parametrize('argument', [
    '_rate:=50', '_goal_distance:= 0.1', '_rate:=1.0e+5', '_surface:=low_ply_carpet', '_surface/nested:=1',
    '__name:=x', '__log:=/tmp/a.log', '__ns:=robot', '/cmd_vel:=/x', 'cmd_vel:=robot/cmd_vel',
    # topic names that are different enough from parameter names
    'odom:=/other/odom', 'imu_data:=imu/data', 'odom_combined:=x', 'reset_odometry:=/reset_odometry'])
def test_what_rospy_understands_passes(argument):
    assert find_problem(argument, NAMES) is None


@pytest.mark.parametrize('argument, problem', [
    ('goal_distance:=0.1', 'this remaps a topic: did you mean _goal_distance:=0.1?'),
    ('~goal_distance:=0.1', 'this remaps a topic: did you mean _goal_distance:=0.1?'),
    ('goal_distanc:=0.1', 'this remaps a topic: did you mean _goal_distance:=0.1?'),
    ('odom_fram:=odom', 'this remaps a topic: did you mean _odom_frame:=odom?'),
    ('_goal_distanc:=0.1', 'unknown parameter: did you mean _goal_distance:=0.1?'),
    ('_distance:=0.1', 'unknown parameter: did you mean _goal_distance:=0.1?'),
    ('_colour:=red', 'unknown parameter'), ('_imu:=1', 'unknown parameter'),
    ('_rtae:=1', 'unknown parameter: did you mean _rate:=1?'),
    ('_goal_distance=0.1', 'unknown argument: did you mean _goal_distance:=0.1?'),
    ('--goal-distance=0.1', 'unknown argument: did you mean _goal_distance:=0.1?'),
    ('--goal-distance', 'unknown argument: did you mean _goal_distance:=VALUE?'),
    ('0.1', f'unknown argument: {EXPECTED}'), ('-v', f'unknown argument: {EXPECTED}'),
    ('__name', f'unknown argument: {EXPECTED}'), ('colour:=0.1', EXPECTED), ('cmd_vel:=', EXPECTED),
    ('_rate:=', 'expected a value'), ('_rate:=[', 'expected a value'), ('_rate:=1:=2', 'expected a value')])
def test_what_rospy_would_drop_is_named(argument, problem):
    assert find_problem(argument, NAMES) == problem
