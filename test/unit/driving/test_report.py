"""An error that rospy or this package detects is one line; a mistake in a script has Python's traceback."""
import sys
from types import SimpleNamespace

import pytest
import rospy

from rbx1_nav.driving import script, stopping
from rbx1_nav.driving.odometry import Straight
from rbx1_nav.node.master import call


def report(monkeypatch, function):
    """Report the error that a function raises; return the lines that are logged, and the error with a traceback."""
    lines, traced = [], []
    monkeypatch.setattr(rospy, 'logerr', lambda text, *values: lines.append(text % values))
    monkeypatch.setattr(sys, '__excepthook__', lambda kind, *_: traced.append(kind))
    monkeypatch.setattr(script, 'end', lambda status: lines.append(f'status {status}'))
    try:
        function()
    except BaseException:
        script._report(*sys.exc_info())
    return lines, traced


def raise_(error):
    raise error


@pytest.mark.parametrize('error, line', [
    (rospy.ROSException('no base: 100 %'), 'no base: 100 %'),
    (rospy.exceptions.ROSTimeMovedBackwardsException(2.0), 'ROS time moved backwards')])
def test_an_error_of_rospy_is_one_line(monkeypatch, error, line):
    lines, traced = report(monkeypatch, lambda: raise_(error))
    assert not traced and line in lines[0] and lines[1:] == ['status 1']


@pytest.mark.parametrize('function', [
    lambda: rospy.get_param('/rate'), lambda: call('http://127.0.0.1:1', 'lookupNode', '/arbotix')])
def test_a_master_that_does_not_answer_is_one_line(monkeypatch, function):
    monkeypatch.setenv('ROS_MASTER_URI', 'http://127.0.0.1:1')
    lines, traced = report(monkeypatch, function)
    assert not traced and 'The master at http://127.0.0.1:1 does not answer' in lines[0] and lines[1:] == ['status 1']


def test_an_error_of_this_package_is_one_line(monkeypatch):
    lines, traced = report(monkeypatch, lambda: Straight('forward', 1e-9, 0.2, 0.05, 50))
    assert not traced and 'goal_distance, min_linear_speed' in lines[0] and lines[1:] == ['status 1']


def test_a_mistake_in_the_script_has_a_traceback(monkeypatch):
    assert report(monkeypatch, lambda: float('a')) == (['status 1'], [ValueError])
    for error, status in (ConnectionRefusedError('a camera'), 1), (KeyboardInterrupt(), 130):
        assert report(monkeypatch, lambda: raise_(error)) == ([f'status {status}'], [type(error)])


def test_an_interrupt_is_quiet(monkeypatch):
    monkeypatch.setattr(stopping, 'is_shutdown', lambda: True)
    monkeypatch.setattr(script, '_interrupted', [])
    assert report(monkeypatch, lambda: raise_(rospy.ROSInterruptException('shutdown requested'))) == ([], [])
    assert len(script._interrupted) == 1        # for the exit status
    reported = []
    monkeypatch.setattr(script, '_thread_excepthook', reported.append)
    errors = [SimpleNamespace(exc_type=kind) for kind in (rospy.ROSInterruptException, ValueError)]
    for error in errors:
        script._report_in_thread(error)
    assert reported == errors[1:]
