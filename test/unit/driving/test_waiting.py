"""rospy.sleep and rospy.Rate of a driving script wait for an instant of the clock that is used, or are interrupted."""
import pytest
import rospy

from rbx1_nav.base.units import SECOND
from rbx1_nav.driving import rate as module, stopping
from rbx1_nav.driving.rate import Rate, sleep

MS = SECOND // 1000


class Clock:
    """A clock that advances by 30 ms while a script waits, or jumps; also the condition on which rospy waits."""

    def __init__(self, monkeypatch, is_wallclock, jump=0):
        self.time, self.step, self.slept, self.shutdown_at = 7 * SECOND, jump or 30 * MS, [], None
        for module_of_now in stopping, module:
            monkeypatch.setattr(module_of_now, 'now', lambda: self.time)
        monkeypatch.setattr(module, 'is_shutdown', lambda: self.shutdown_at and self.time > self.shutdown_at)
        monkeypatch.setattr(module, 'check_shutdown', self.check_shutdown)
        monkeypatch.setattr(module.life, 'sleep', lambda seconds: self.advance(round(seconds * SECOND)))
        monkeypatch.setattr(rospy.rostime, 'is_wallclock', lambda: is_wallclock)
        monkeypatch.setattr(rospy.rostime, 'get_rostime', lambda: rospy.Time(0, self.time))
        monkeypatch.setattr(rospy.rostime, 'get_rostime_cond', lambda: self)
        monkeypatch.setattr(stopping.Commands, 'current', None)

    def check_shutdown(self):
        if module.is_shutdown():
            raise rospy.ROSInterruptException('shutdown requested')

    def advance(self, duration):
        self.slept.append(duration / MS)
        self.time += min(duration, self.step)

    def __enter__(self):
        pass

    def __exit__(self, *_):
        pass

    def wait(self, _):
        self.slept.append(None)
        self.time += self.step


@pytest.mark.parametrize('duration', [0.1, rospy.Duration(0, 100 * MS)])
@pytest.mark.parametrize('is_wallclock, slept', [(True, [100, 70, 40, 10]), (False, [None] * 4)])
def test_a_sleep_is_as_long_as_requested(monkeypatch, duration, is_wallclock, slept):
    clock = Clock(monkeypatch, is_wallclock)
    sleep(duration)
    assert clock.slept == slept and clock.time >= 7 * SECOND + 100 * MS
    sleep(0)
    sleep(-1)
    assert clock.slept == slept


def test_a_sleep_of_a_shutdown_function_is_wall_time(monkeypatch):
    slept = []
    monkeypatch.setattr(module, 'is_shutdown_function', lambda: True)
    monkeypatch.setattr(module.time, 'sleep', slept.append)
    for duration in 0.25, rospy.Duration(2), -1:
        sleep(duration)
    assert slept == [0.25, 2.0, 0.0]


@pytest.mark.parametrize('is_wallclock', [True, False])
def test_a_request_interrupts_a_sleep(monkeypatch, is_wallclock):
    clock = Clock(monkeypatch, is_wallclock)
    clock.shutdown_at = clock.time + 70 * MS
    with pytest.raises(rospy.ROSInterruptException):
        sleep(SECOND)
    assert len(clock.slept) == 3


def test_a_clock_that_jumps_back(monkeypatch):
    Clock(monkeypatch, False, jump=-2 * SECOND)
    with pytest.raises(rospy.exceptions.ROSTimeMovedBackwardsException) as error:
        sleep(1)
    assert error.value.time == 2


def test_on_simulated_time_a_tick_begins_after_the_clock_has_advanced(monkeypatch):
    clock = Clock(monkeypatch, False)
    module.wait_for_tick()
    assert clock.time == 7 * SECOND + 30 * MS
    clock = Clock(monkeypatch, True)
    module.wait_for_tick()
    assert not clock.slept


def test_without_a_drive_the_ticks_are_those_of_rospy(monkeypatch):
    sleeps = []
    clock = Clock(monkeypatch, True)
    monkeypatch.setattr(rospy, 'sleep', lambda duration: sleeps.append(duration.to_nsec() / MS))
    monkeypatch.setattr(rospy.timer, 'sleep', lambda duration: sleeps.append(duration.to_nsec() / MS))
    r = Rate(25)
    clock.time += 15 * MS
    r.sleep()
    assert sleeps == [25]
