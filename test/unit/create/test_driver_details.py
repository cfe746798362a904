"""Details of the driver: its steps for the gyro, its repeated stops, its counters and what it is waiting for."""
from math import radians
from types import SimpleNamespace

import pytest

from rbx1_nav.create import protocol
from rbx1_nav.create.driver import sequences
from rbx1_nav.units import SECOND

from driven_create import DrivenCreate, started

BOTH = pytest.mark.parametrize('robot_type', ['create', 'create2'])


def recorded(driven):
    """Return the list to which the driver adds its steps for the gyro."""
    steps = []
    driven.driver.gyro = SimpleNamespace(update=lambda count, step: steps.append(step))
    return steps


def sent(driven):
    """Return the list to which the times (ns) and bytes of what the driver sends are added."""
    data, write = [], driven.write
    driven.driver.sender.open(lambda each: (data.append((driven.now, each)), write(each)))
    return data


# the gyro

def test_the_step_of_a_turn():
    driven = started('create', odom_angular_error=0.1, odom_heading_error=0.2, odom_linear_error=0.5)
    steps = recorded(driven)
    driven.drive(0.1, 1.0, 2)
    step = steps[-1]
    assert step.elapsed == pytest.approx(1 / 30, abs=0.004)     # a step of the driver takes 2 ms
    assert step.commanded == pytest.approx(step.elapsed, rel=0.01)      # 1 mm/s of 130 mm/s
    assert sum(each.turn for each in steps) == pytest.approx(driven.pose.yaw)
    # errors after 1 rad and after 1 m, and the rounding to 1 degree, which is uniformly distributed
    distance = 0.1 * step.elapsed
    assert step.variance == pytest.approx(
        0.1 ** 2 * abs(step.turn) + 0.2 ** 2 * distance + radians(1) ** 2 / 12, rel=0.3)    # the distance is rounded
    assert not step.at_rest and step.driven and not step.touched and not step.missing
    steps.clear()
    driven.drive(0, -1.0, 2)
    # the first two of 60 readings belong to the turn before, at least in part: 1/30 and 0 rad instead of -1/30 each
    assert sum(each.commanded for each in steps) == pytest.approx(-2 + 3 / 30, abs=0.02)    # speeds in whole mm/s


def test_the_step_at_rest():
    driven = started('create')
    steps = recorded(driven)
    driven.run(0.1)
    assert all(step.at_rest and step.driven and not step.touched for step in steps) and steps
    for fault, at_rest in ('bumped', True), ('wheel_dropped', False):
        setattr(driven.body, fault, True)
        driven.run(0.1)
        assert steps[-1].at_rest == at_rest and steps[-1].touched
        setattr(driven.body, fault, False)


def test_in_passive_mode_the_power_of_the_gyro_is_not_switched_on():
    driven = started('create', operation_mode=1)
    steps = recorded(driven)
    driven.run(0.1)
    assert steps and driven.driver.supervisor.in_control and not any(step.driven for step in steps)


@pytest.mark.parametrize('seconds, missing', [(0.05, False), (0.16, True)])
def test_readings_are_missing_after_more_than_three_periods(seconds, missing):
    driven = started('create')
    steps = recorded(driven)
    driven.run(0.1)
    driven.stall(seconds)
    driven.run(0.1)
    assert any(step.missing for step in steps) == missing


# readings

def test_a_slow_line_at_the_highest_update_rate_loses_no_reply():
    """A reply takes 16 ms, so the next query is due while it arrives."""
    driven = DrivenCreate('create', update_rate=60, baud=19200)
    driven.line.baud = 19200
    driven.connect()
    driven.run(3)
    driven.drive(0.2, 0.5, 2)
    queries = driven.driver.queries
    assert queries.missed == queries.reader.rejected == queries.reader.skipped == 0


def test_the_time_of_a_reply_is_the_time_of_its_query():
    driven = started('create')
    data = sent(driven)
    driven.run(0.2)
    queries = {time for time, each in data if each[0] == protocol.OPCODES['query_list']}
    assert {state.time for state in driven.states[-3:]} <= queries


@pytest.mark.parametrize('baud', [38400, 57600, 115200])
def test_a_create_2_may_have_any_rate(baud):
    driven = DrivenCreate('create2', baud=baud)
    driven.line.baud = baud
    driven.connect()
    driven.run(3)
    assert driven.driver.supervisor.in_control
    assert driven.driver.sender.byte == 10 * SECOND // baud


@BOTH
def test_implausible_readings_are_counted(robot_type):
    driven = started(robot_type)
    travel = driven.driver.counter.update

    def update(reading, elapsed, expected):
        if driven.driver.implausible < 2:
            reading = {**reading, 'distance': 5000, 'left_encoder': 30000}
        return travel(reading, elapsed, expected)
    driven.driver.counter.update = update
    driven.run(0.3)
    assert driven.driver.implausible == 2 and driven.pose == (0, 0, 0)
    assert driven.driver.queries.missed == 2


# commands

@BOTH
def test_commands_above_the_speed_limit_are_counted(robot_type):
    driven = started(robot_type)
    for linear, count in ((0.5, 0), (0.51, 1), (-0.6, 2), (0.2, 2)):
        driven.command(linear, 0)
        assert driven.driver.saturated == count


@BOTH
def test_a_command_times_out_at_its_expiry(robot_type):
    driven = started(robot_type, cmd_vel_timeout=0.25)
    driven.command(0.2, 0)
    assert not driven.driver.tick(driven.now + SECOND // 4 - 1) and driven.gate.moving
    assert driven.driver.tick(driven.now + SECOND // 4) and not driven.gate.moving
    assert not driven.driver.tick(driven.now + SECOND // 4)


@BOTH
def test_a_base_is_ready_when_the_robot_can_be_driven_or_the_reason_is_known(robot_type):
    driven = DrivenCreate(robot_type, robot=robot_type)
    driven.body.wheel_dropped = True
    assert not driven.driver.is_ready
    driven.connect()
    assert not driven.driver.is_ready
    driven.run(3)
    assert driven.driver.is_ready and not driven.driver.supervisor.in_control
    assert started(robot_type).driver.is_ready


@BOTH
def test_what_is_awaited(robot_type):
    driven = DrivenCreate(robot_type)
    driven.connect()
    assert driven.driver.awaited is driven.driver.contact.search
    wait = driven.driver.until_tick(driven.now)
    times = driven.driver.contact.search.next_time, driven.driver.schedule.next
    assert wait == max(0, min(times) - driven.now) / SECOND
    driven.run(2)
    while driven.driver.due is not None:
        driven.run(0.002)
    assert driven.driver.awaited is None
    assert driven.driver.until_tick(driven.now) == (driven.driver.schedule.next - driven.now) / SECOND
    assert driven.driver.until_tick(driven.now + SECOND) == 0
    while driven.driver.due is None:
        driven.run(0.002)
    assert driven.driver.awaited is driven.driver.queries.reader
    driven.driver.leave(driven.now)
    assert driven.driver.awaited is driven.driver.queries.reader


# the last stop

@BOTH
def test_the_last_stop_is_repeated_0_1_s_after_its_transmission(robot_type):
    driven = started(robot_type)
    driven.drive(0.2, 0, 0.3)
    driven.line.silent = True
    data = sent(driven)
    driven.driver.leave(driven.now)
    driven.run(1)
    stop = sequences.leave(driven.settings.model)
    stops = [(time, each) for time, each in data if each.endswith(stop)]
    assert [each for _, each in stops] == [stop] + [sequences.FLUSH + stop] * (len(stops) - 1) and len(stops) > 4
    # 512 bytes before it
    flush = 512 * 10 * SECOND // driven.driver.baud
    for index, ((before, _), (after, _)) in enumerate(zip(stops, stops[1:])):
        wait = after - before - (flush if index else 0)
        assert SECOND // 10 < wait <= SECOND // 10 + 2 * SECOND // 500      # a step of the driver


def test_a_robot_that_was_never_found_needs_no_stop():
    driven = DrivenCreate('create')
    driven.driver.leave(driven.now)
    assert driven.driver.left


@BOTH
def test_settings_that_were_restored(robot_type):
    driven = started(robot_type)
    model = driven.settings.model
    data = sent(driven)
    driven.driver.restore(driven.now)
    assert data[-1][1] == sequences.STOP + sequences.take_control(model, protocol.SAFE)
    driven.body.wheel_dropped = True
    driven.run(0.3)
    driven.driver.restore(driven.now)
    assert data[-1][1] == sequences.STOP + sequences.START
    driven.driver.leave(driven.now)
    count = len(data)
    driven.driver.restore(driven.now)
    assert len(data) == count


# the log

@BOTH
def test_what_is_logged_when_the_robot_answers_again(robot_type):
    driven = started(robot_type)
    driven.drive(0.2, 0, 1)
    driven.line.silent = True
    driven.run(1)
    driven.line.silent = False
    driven.run(1)
    line, = [line for line in driven.log if 'answers again' in line]
    # a second of silence, and the time until the robot has answered a query
    assert 1.0 <= float(line[len('The robot answers again, after '):-len(' s')]) <= 1.6
    assert driven.driver.acceptance.lockout.reason.startswith('the robot did not answer for 1.')
    driven.command_zero()
    driven.drive(0.2, 0, 1)
    driven.robot.switch_on(driven.now)
    driven.run(3)
    line, = [line for line in driven.log if line.endswith(' s: it was switched off or reset')]
    assert 1.0 <= float(line[len('The robot answers again, after '):line.index(' s:')]) <= 2.5
    assert driven.driver.acceptance.lockout.reason == 'the robot was switched off or reset'


def test_a_short_silence_locks_nobody_out():
    driven = started('create2')
    driven.pull()
    driven.run(0.2)
    driven.connect()
    driven.run(0.3)
    assert any(line.startswith('The robot answers again') for line in driven.log)
    assert not driven.driver.acceptance.lockout.reason


def test_the_robot_that_was_found_is_logged_with_its_rate():
    driven = DrivenCreate('auto', robot='create2')
    driven.line.baud = 19200
    driven.connect()
    driven.run(3)
    assert driven.log == ['The robot answers: create2 at 19200 baud', 'The robot is in safe mode']
