"""After an outage of the network, commands that were sent meanwhile do not drive a base; nothing else is dropped."""
import random

import pytest

from rbx1_nav.base.command_gate import CommandGate
from rbx1_nav.base.late_commands import Bursts
from rbx1_nav.base.robot_parameters import Limits
from rbx1_nav.base.units import SECOND
from rbx1_nav.simulation.gyro import IdealGyro
from rbx1_nav.simulation.simulated_base import SimulatedBase
from rbx1_nav.simulation.wheels import IdealWheels

TIMEOUT, SPEED = 0.6, 0.2       # s, m/s
RATES = pytest.mark.parametrize('rate', [5, 10, 20, 50, 100])
MILLISECOND = 0.001


def drive(arrivals, steps=50, until=None):
    """Drive a base with commands that arrive at times in s. Returns (dropped, [(time, x)], the last time at a step)."""
    gate = CommandGate(Limits(1.0, 1.0), round(TIMEOUT * SECOND))
    base, bursts = SimulatedBase(IdealWheels(0.26), gate, IdealGyro()), Bursts(gate.timeout)
    dropped, track = [], []
    end = until or max(arrivals) + 2
    events = sorted([(time, True) for time in arrivals] + [(step / steps, False) for step in range(round(end * steps))])
    for time, is_command in events:
        now = round(time * SECOND)
        if is_command:
            drops = bursts.drops(now, 'driver')
            if drops:
                dropped.append(time)
            base.command(now, 0.0 if drops else SPEED, 0.0)
        else:
            base.advance(now)
            bursts.ran = now
            track.append((time, base.odometry.pose.x))
    return dropped, track


def x_at(track, time):
    return next(x for at, x in track if at >= time)


def sent(rate, seconds, begin=0.0):
    return [begin + number / rate for number in range(round(rate * seconds))]


def over_a_network(times, begin, end, pause):
    """Return when commands arrive: those of an outage after it, with a pause (s) between two of them."""
    held = [time for time in times if begin <= time < end]
    late = [end + number * pause for number in range(len(held))]
    return sorted([time for time in times if not begin <= time < end] + late)


@RATES
@pytest.mark.parametrize('outage', [1.0, 3.0, 8.0, 10.0])
@pytest.mark.parametrize('pause', [0.0, 1e-5, 5e-4])
def test_a_dead_sender_does_not_drive_after_an_outage(pause, outage, rate):
    for part in 0.4, 0.7, 1.0:      # the sender dies in the outage
        times = sent(rate, 3.0 + part * outage)
        dropped, track = drive(over_a_network(times, 3.0, 3.0 + outage, pause), until=10 + outage)
        before = x_at(track, 3.0 + outage - 0.02)
        count = len(times) - 3 * rate       # up to three are not known to be old
        assert track[-1][1] - before <= (BURST_TRAVEL if count > 3 else SPEED * (TIMEOUT + 0.02))
        assert len(dropped) == max(0, count - 3)


BURST_TRAVEL = 0.005        # m


@RATES
@pytest.mark.parametrize('outage', [1.0, 3.0, 10.0])
def test_a_live_sender_drives_on_within_a_second(outage, rate):
    times = sent(rate, 8.0 + outage)
    dropped, track = drive(over_a_network(times, 3.0, 3.0 + outage, 1e-5))
    assert all(time < 4.0 + outage for time in dropped)
    since = 4.0 + outage
    assert x_at(track, since + 2) - x_at(track, since) == pytest.approx(2 * SPEED, abs=1e-6)


@RATES
@pytest.mark.parametrize('seed', range(5))
def test_a_sender_that_rests_loses_no_command(rate, seed):
    """It is late at times, and then sends what is due at once, as rospy.Rate does."""
    choose = random.Random(seed)
    times, now = [], 0.0
    for _ in range(30):
        now += choose.uniform(TIMEOUT, 3)
        for number in range(choose.randrange(1, 40)):
            late = choose.uniform(0, 2 / rate) if choose.random() < 0.2 else 0.0
            times.append(max([now + number / rate + late] + times[-1:]))
        now = times[-1]
    assert not drive(times)[0]


@pytest.mark.parametrize('together', [2, 3, 4])
def test_a_sender_that_always_sends_several_commands_at_once_loses_none(together):
    times = sorted(together * sent(20, 3)) + sorted(together * sent(20, 3, 5.0))
    assert not drive(times)[0]


def test_a_sender_that_becomes_faster_loses_none_and_one_that_sends_more_at_once_is_followed_after_half_a_second():
    assert not drive(sent(5, 3) + sent(200, 3, 5.0))[0]
    dropped, _ = drive(sent(5, 3) + sorted(4 * sent(20, 3, 5.0)))
    assert dropped and all(time < 5.56 for time in dropped)


def test_a_burst_that_grows_with_each_round_trip_is_recognized():
    """TCP begins again with one segment, and doubles their number with each answer, here after 5 ms."""
    times = [8.0 + 0.005 * trip + 1e-4 * number for trip in range(5) for number in range(2 ** trip)]
    dropped, track = drive(sent(20, 3) + times, until=10)
    assert len(dropped) == len(times) - 6 and track[-1][1] - x_at(track, 7.9) <= BURST_TRAVEL


# what other programs send while a user drives for `seconds`, after their sources

def joystick(period, autorepeat):
    """teleop_twist_joy with joy_node: a message for each event, `period` s apart while the stick moves; if it rests, at
    the rate `autorepeat`, 0: none."""
    def times(choose, begin, seconds):
        found = [begin]
        while found[-1] < begin + seconds:
            found += [found[-1] + number * period for number in range(1, choose.randrange(1, 100))]
            found += [found[-1] + number / autorepeat for number in range(1, choose.randrange(40)) if autorepeat]
        return found
    return times


def keyboard(delay, rate, repeat_rate=0):
    """teleop_twist_keyboard: a message for each repetition of the key, and at `repeat_rate` in between."""
    def times(choose, begin, seconds):
        repeated = [begin + delay + number / rate for number in range(round(seconds * rate))]
        keys = [begin, *repeated, begin + 2 * seconds]
        return [time + number / repeat_rate if repeat_rate else time for time, after in zip(keys, keys[1:])
                for number in range(1 + int((after - time) * repeat_rate))]
    return times


def loop(rate):
    """ros::Rate: move_base, velocity smoothers; setInterval and requestAnimationFrame: web pages with roslibjs. A late
    tick delays the others."""
    def times(choose, begin, seconds):
        found = [begin]
        while found[-1] < begin + seconds:
            found.append(found[-1] + 1 / rate + (choose.uniform(0, 2 / rate) if choose.random() < 0.2 else 0))
        return found
    return times


def muxed(*streams):
    """twist_mux and cmd_vel_mux: each message is passed on at once; a second source takes over."""
    def times(choose, begin, seconds):
        first, second = (stream(choose, begin, seconds) for stream in streams)
        return [time for time in first if time < second[-1]] + [second[-1] + time - begin for time in second]
    return times


@pytest.mark.parametrize('stream', [
    *(joystick(period, autorepeat) for period in (0.001, 0.002, 0.004, 0.008, 0.017) for autorepeat in (0, 20, 50)),
    keyboard(0.5, 30), keyboard(0.66, 25), keyboard(0.25, 10.9), keyboard(0.2, 60, 10), keyboard(0.5, 30, 10),
    *map(loop, (5, 10, 20, 60, 100, 250)), muxed(joystick(0.004, 20), loop(20))])
def test_no_command_of_another_program_is_dropped(stream):
    choose, times, now = random.Random(1), [], 0.0
    for _ in range(25):
        times += stream(choose, now + choose.uniform(0, 3), choose.uniform(0.1, 3))
        now = max(times)
    assert not drive(times)[0]


@pytest.mark.parametrize('rate', [10, 20, 60])
def test_a_page_whose_first_messages_are_held_up_loses_two_more(rate):
    """A radio that sleeps holds up 5 messages, which are late, too."""
    times = sent(rate, 3) + [6.0 + max(5 / rate + 1e-4 * index, index / rate) for index in range(3 * rate)]
    dropped, _ = drive(times)
    assert dropped and max(dropped) < 6 + 7.1 / rate


def test_a_silence_in_which_the_base_did_not_run_says_nothing():
    bursts = Bursts(SECOND)
    for number in range(50):
        bursts.ran = number * SECOND // 50
        assert not bursts.drops(bursts.ran, 'driver')
    assert not any(bursts.drops(5 * SECOND, 'driver') for _ in range(50))
    for number in range(50):
        assert not bursts.drops(6 * SECOND + number * SECOND // 50, 'driver')
    bursts.ran = 10 * SECOND
    assert [bursts.drops(10 * SECOND, 'driver') for _ in range(5)] == 3 * [False] + 2 * [True] and bursts.dropped == 2


def test_a_base_that_does_not_stop_by_itself_drops_nothing():
    bursts = Bursts(0)
    assert not any(bursts.drops(number // 20 * 10 * SECOND, 'driver') for number in range(100))


def test_only_the_latest_senders_are_stored():
    bursts = Bursts(SECOND)
    for number in range(100):
        bursts.drops(number, str(number))
    assert len(bursts.spacings) == 20 and '99' in bursts.spacings
