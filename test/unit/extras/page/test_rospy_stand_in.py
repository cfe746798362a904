"""A driving script runs unchanged with the stand-in for rospy, and whatever it cannot do there is named."""
from math import atan2, pi, remainder
import os
import sys
import threading

import pytest

from page_runs import CONFIG, ROOT, request, run_script

with open(os.path.join(ROOT, 'nodes', 'timed_out_and_back.py')) as file:
    TIMED = file.read()
BEGIN = ('import rospy\n'
         'from geometry_msgs.msg import Twist\n'
         'rospy.init_node("own")\n'
         'pub = rospy.Publisher("/cmd_vel", Twist, queue_size=5)\n'
         'twist = Twist()\n'
         'twist.linear.x = 0.3\n')


# the messages of ROS on simulated time, seed 7: x, y (m); z, w of the orientation
CARPET = {'truth': (0.09571674086792029, 0.4822236065060018, 0.47672058887404767, -0.8790548789146109),
          'odometry': (0.10352005548880171, 0.4288564865226204, 0.45657726608903026, -0.8896837640929877)}
IDEAL = dict.fromkeys(CARPET, (1.2682724593940375e-06, 0.0015926529164846123, 0.0015926529165099209,
                               -0.9999987317275395))


@pytest.mark.parametrize('surface, ends', [('ideal', IDEAL), ('low_ply_carpet', CARPET)])
def test_the_script_of_the_tutorial_ends_where_it_does_with_ros(surface, ends):
    frame, log = run_script(TIMED, surface=surface)
    for source, (x, y, z, w) in ends.items():
        pose = frame['poses'][source]
        # 1e-9 is far above the rounding in a thousand steps
        assert pose[:2] == pytest.approx([x, y], abs=1e-9)
        assert remainder(pose[2] - 2 * atan2(z, w), 2 * pi) == pytest.approx(0, abs=1e-9)
    assert log == ['Stopping the robot...'] and frame['status']['outcome'] == 'finished'
    assert frame['run'] == 'script' and frame['time'] == pytest.approx(request('timed')[-1]['time'] + 1)


def test_edited_parameters():
    assert run_script(TIMED, goal_distance=0.5)[0]['poses'] == run_script(
        TIMED.replace("'~goal_distance', 1.0", "'~goal_distance', 0.5"))[0]['poses']
    assert max(x for x, _, _ in run_script(TIMED, goal_distance=0.5)[0]['paths']['truth']) == pytest.approx(0.5)


def test_stop_calls_the_functions_of_on_shutdown():
    frame, log = run_script(TIMED, stop=3.0)
    assert log == ['Stopping the robot...', 'Out-and-Back node terminated.']
    assert frame['status']['outcome'] == 'stopped' and frame['poses']['truth'][0] == pytest.approx(0.6)
    assert frame['time'] == pytest.approx(4.0)      # with the second in shutdown()


def test_a_script_of_its_own():
    frame, log = run_script(BEGIN + (
        'begin, rate = rospy.Time.now(), rospy.Rate(30)\n'
        'while not rospy.is_shutdown() and (rospy.Time.now() - begin).to_sec() < 1.5:\n'
        '    pub.publish(twist)\n'
        '    rate.sleep()\n'
        'pub.publish(Twist())\n'
        'rospy.sleep(rospy.Duration(0.5))\n'
        'rospy.logwarn("%d of %s", 3, rospy.get_param("~side", 7))\n'
        'print("a", 4)\n'
        'rospy.signal_shutdown("done")\n'
        'pub.publish(twist)\n'
        'rospy.sleep(1)\n'))
    assert frame['poses']['truth'][0] == pytest.approx(0.3 * 1.5, abs=0.3 * 0.04)   # two steps of the clock
    assert log == ['3 of 7', 'a 4'] and frame['status']['outcome'] == 'finished'


def test_a_robot_that_is_left_moving_stops_as_the_base_does():
    frame, log = run_script(BEGIN + 'pub.publish(linear=twist.linear)\n')
    assert frame['poses']['truth'][0] == pytest.approx(0.3) and frame['time'] == pytest.approx(1.0)     # its timeout


@pytest.mark.parametrize('text, line', [
    ('raise ValueError("two\\nlines")\n', 'line 7: ValueError: two lines'),
    ('twist.linear.X = 1\n', "line 7: AttributeError: 'Vector3' object has no attribute 'X'"),
    ('def drive():\n    return 1 / 0\ndrive()\n', 'line 8: ZeroDivisionError: division by zero'),
    ('rospy.Subscriber("odom", print)\n', 'line 7: rospy.Subscriber does not exist on this page'),
    ('from geometry_msgs.msg import Pose\n', 'line 7: geometry_msgs.msg.Pose does not exist on this page'),
    ('from rbx1_nav.driving import PoseListener\n', 'line 7: rbx1_nav.driving.PoseListener does not exist'),
    ('import no_such_module\n', 'line 7: the module no_such_module does not exist on this page'),
    ('import threading\nthreading.Thread(target=print).start()\n', 'line 8: threads do not exist on this page'),
    ('rospy.Publisher("odom", Twist)\n', 'line 7: the topic odom does not exist on this page: expected cmd_vel'),
    ('rospy.get_param("~speed")\n', "line 7: KeyError: 'speed'"),
    ('if True print\n', 'line 7: syntax error: '),
    ('pub.publish(twist)\nwhile True: pub.publish(twist)\n', 'line 8: no rospy.sleep() or Rate.sleep() for 0.1 s: '),
    ('try:\n    while True: pass\nexcept Exception: pass\n', 'line 8: no rospy.sleep() or Rate.sleep() for 0.1 s: '),
])
def test_an_error_is_one_line_with_the_line_number(monkeypatch, text, line):
    monkeypatch.setattr('rbx1_nav.extras.page.runner.PATIENCE', 0.1)
    frame, log = run_script(BEGIN + text)
    assert len(log) == 1 and log[0].startswith(line), log
    assert frame['status']['outcome'] == 'failed; see the log'


def test_rospy_before_init_node():
    assert run_script('import rospy\nrospy.Rate(5)\n')[1] == ['line 2: expected rospy.init_node() before this line']


@pytest.mark.parametrize('x, lines, line, end', [
    (0.7, 1, '0.7 m/s, 0 rad/s: expected at most 0.5 m/s, 3.8 rad/s; clamped', 0.5),
    (float('nan'), 2, 'Rejected a command: nan', 0)])
def test_a_command_that_is_not_followed_is_logged(x, lines, line, end):
    frame, log = run_script(BEGIN + f'twist.linear.x = float("{x}")\npub.publish(twist)\n' * 2)
    assert log[0].startswith(line) and len(log) == lines and frame['poses']['truth'][0] == pytest.approx(end)


def test_a_script_ends_after_300_simulated_seconds_also_in_a_function_of_on_shutdown():
    frame, log = run_script(BEGIN + 'rospy.on_shutdown(lambda: rospy.sleep(20))\nrospy.sleep(1000)\n')
    assert frame['status']['outcome'] == 'stopped, because 300 s have passed' and frame['time'] < 311
    assert log == []


def test_nothing_is_left_behind():
    before = dict(sys.modules), threading.Thread.start, sys.gettrace(), sys.stdout
    run_script(BEGIN + 'import colorsys\n')
    assert (dict(sys.modules), threading.Thread.start, sys.gettrace(), sys.stdout) == before
    assert CONFIG['surfaces']['ideal'] == {}
