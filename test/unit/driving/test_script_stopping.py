"""What a script has commanded: distances, the number of commands, and how late they were."""
from math import inf, nan
from threading import Event
from types import SimpleNamespace

from geometry_msgs.msg import Twist, Vector3
import pytest
import rospy

from rbx1_nav.base.units import SECOND
from rbx1_nav.driving import stopping as module
from rbx1_nav.driving import rate as rates
from rbx1_nav.driving.rate import Rate
from rbx1_nav.driving.stopping import Commands

MS = SECOND // 1000


class Listeners:
    """Listeners that follow all commands, unless they have a problem."""

    def __init__(self, on_clock_of_base):
        self.on_clock_of_base, self.text = on_clock_of_base, ''

    def problem(self):
        return self.text


class Publisher:
    data_class = Twist
    resolved_name = '/cmd_vel'


class Clock:
    """A clock that only a Rate and the test advance, and what is published on it."""

    def __init__(self, monkeypatch, on_clock_of_base=False, timed=True):
        self.now = 7 * SECOND
        self.sent = []      # (ns, linear.x, angular.z)
        self.failures, self.logged, self.fail = [], [], module.fail
        monkeypatch.setattr(module, 'now', lambda: self.now)
        monkeypatch.setattr(rates, 'now', lambda: self.now)
        monkeypatch.setattr(rates, '_wait_until', self.wait_until)
        monkeypatch.setattr(module, 'fail', self.failures.append)
        monkeypatch.setattr(rates, 'fail', self.failures.append)
        monkeypatch.setattr(module, '_publish', self.send)
        monkeypatch.setattr(module, '_moving', {})
        for name in 'loginfo', 'logerr':
            monkeypatch.setattr(rospy, name, lambda text, *values: self.logged.append(text % values))
        monkeypatch.setattr(rospy.rostime, 'get_rostime', lambda: rospy.Time(0, self.now))
        self.commands = Commands(Publisher, Listeners(on_clock_of_base), timed)
        monkeypatch.setattr(Commands, 'current', self.commands)

    def wait_until(self, end):
        self.now = max(self.now, end)

    def send(self, _, message):
        assert module._lock._is_owned()    # or a command to move may follow a stop of another thread
        self.sent.append((self.now, message.linear.x, message.angular.z))

    def publish(self, linear=0.0, angular=0.0):
        message = Twist()
        message.linear.x, message.angular.z = linear, angular
        module.publish(Publisher, message)

    def intervals(self):
        """Milliseconds between the commands."""
        return [(after[0] - before[0]) / MS for before, after in zip(self.sent, self.sent[1:])]


def test_distance_and_angle(monkeypatch):
    clock = Clock(monkeypatch)
    clock.now += SECOND
    for linear, angular, milliseconds in (0.3, 0.0, 500), (0.2, -0.8, 250), (0.0, 0.0, 1000), (-0.1, 0.4, 100):
        clock.publish(linear, angular)
        clock.now += milliseconds * MS
    clock.publish()
    assert clock.commands.distance == pytest.approx(0.15 + 0.05 - 0.01)
    assert clock.commands.angle == pytest.approx(-0.8 * 0.25 + 0.04)
    assert clock.commands.motions == 2 and clock.logged == [
        '2 commands in 0.75 s: 0.20 m forward, -0.20 rad to the left',
        '1 commands in 0.10 s: -0.01 m forward, 0.04 rad to the left']
    assert clock.commands.result()[1] == (
        'Done: commanded 0.19 m forward and -0.16 rad to the left. The longest delay of a command was 0 ms. To see '
        'where the robot is now, run: rosrun rbx1_nav pose.py')


def drive(clock, stall_at, stall, ticks=10):
    """Drive for a number of ticks of 20 ms; the script stalls after one of the commands, for a number of ms."""
    r = Rate(50)
    for tick in range(ticks):
        clock.publish(0.2)
        if tick == stall_at:
            clock.now += stall * MS
        r.sleep()
    clock.publish()


def test_a_delay_is_made_up_for(monkeypatch):
    clock = Clock(monkeypatch)
    drive(clock, 2, 45)
    # at least 0.6 periods apart, and 10 periods in all
    assert clock.intervals() == [20, 20, 45, 12, 12, 12, 19, 20, 20, 20]
    assert clock.commands.longest == 25 * MS and not clock.failures
    log, text = clock.commands.result()
    assert log is rospy.logwarn and 'of a command was 25 ms, more than a period' in text


def test_a_delay_of_a_resting_robot_is_not(monkeypatch):
    clock = Clock(monkeypatch)
    r = Rate(50)        # made once, as in the book
    for _ in range(2):
        for _ in range(3):
            clock.publish(0.2)
            r.sleep()
        clock.publish()
        clock.now += SECOND
    clock.publish(0.2)
    Rate(50).sleep()    # made in the motion
    rates.sleep(0.3)    # on purpose
    clock.publish()
    assert clock.intervals() == [20, 20, 20, 1000, 20, 20, 20, 1000, 320]
    assert clock.commands.longest == 0 and clock.commands.result()[0] is rospy.loginfo


def test_on_the_clock_of_the_base_ticks_follow_immediately(monkeypatch):
    clock = Clock(monkeypatch, on_clock_of_base=True)
    drive(clock, 2, 45)
    assert clock.intervals() == [20, 20, 45, 0, 15, 20, 20, 20, 20, 20]


@pytest.mark.parametrize('timed, stall, failures', [(True, 75, 1), (True, 69, 0), (False, 75, 0)])
def test_a_stop_that_is_more_than_50_ms_late_fails(monkeypatch, timed, stall, failures):
    clock = Clock(monkeypatch, timed=timed)
    drive(clock, 9, stall)
    assert len(clock.failures) == failures
    assert clock.sent[-1] == (7 * SECOND + (180 + stall) * MS, 0.0, 0.0)
    assert not failures or clock.failures[0].startswith('The robot was stopped 0.06 s late')


def test_a_delay_of_more_than_a_second_fails(monkeypatch):
    clock = Clock(monkeypatch)
    drive(clock, 2, 1030)
    assert clock.failures[0].startswith('A command is 1.0 s late: expected at most 1 s')


@pytest.mark.parametrize('field', ['linear.x', 'linear.y', 'linear.z', 'angular.x', 'angular.y', 'angular.z'])
@pytest.mark.parametrize('value', [-1e-9, nan, inf])
def test_after_a_request_only_a_zero_twist_is_published(monkeypatch, field, value):
    clock = Clock(monkeypatch)
    message = Twist()
    vector, axis = field.split('.')
    setattr(getattr(message, vector), axis, value)
    module.publish(Publisher, message)
    assert len(clock.sent) == 1 and list(module._moving) == ['/cmd_vel']
    module.end_requested.set()
    try:
        with pytest.raises(rospy.ROSInterruptException):
            module.publish(Publisher, message)
        assert len(clock.sent) == 1
        module.stop_robots()
        module.publish(Publisher, Twist())
        assert len(clock.sent) == 3 and not module._moving and not module._lock._is_owned()
        module.stop_robots()
        assert len(clock.sent) == 3
    finally:
        module.end_requested.clear()


def test_a_base_with_a_problem_is_stopped_and_another_topic_is_none_of_its(monkeypatch):
    clock = Clock(monkeypatch)
    clock.publish(0.2)
    clock.commands.listeners.text = 'lost'
    clock.publish(0.3)
    module.publish(SimpleNamespace(data_class=Twist, resolved_name='/arm'), linear=Vector3(0.4, 0, 0))
    assert clock.failures == ['lost'] and clock.commands.linear == 0.2
    module.halt()
    assert [linear for _, linear, _ in clock.sent] == [0.2, 0.4, 0.0, 0.0] and not module._moving


def test_the_first_error_ends_the_script(monkeypatch):
    clock, ended, wanted, status, seen = Clock(monkeypatch), Event(), Event(), [9], []
    for name, value in dict(end_requested=ended, request_end=ended.set, shutdown_wanted=wanted, exit_status=status,
                            _signal_shutdown=lambda _: seen.append(module.is_shutdown())).items():
        monkeypatch.setattr(module, name, value)
    clock.publish(0.2)
    with pytest.raises(rospy.ROSInterruptException):
        clock.fail('lost')
    module.end(3, 'later')
    assert (status, clock.logged, wanted.is_set(), clock.sent[-1][1]) == ([1], ['lost'], True, 0.0)
    module.signal_shutdown('')      # to the functions of rospy.on_shutdown, rospy is still running
    assert seen == [False] and module.is_shutdown()
