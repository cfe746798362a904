"""Details of the driver: its repeated stops, its counters and what it logs."""
import pytest

from rbx1_nav.create import protocol
from rbx1_nav.create.driver import sequences
from rbx1_nav.units import SECOND

from driven_create import DrivenCreate, started

BOTH = pytest.mark.parametrize('robot_type', ['create', 'create2'])


def sent(driven):
    """Return the list to which the times (ns) and bytes of what the driver sends are added."""
    data, write = [], driven.write
    driven.driver.sender.use_line(lambda each: (data.append((driven.now, each)), write(each)))
    return data


# readings

def test_a_slow_line_at_the_highest_update_rate_loses_no_reply():
    """A reply takes 16 ms, so the next query is due while it arrives."""
    driven = DrivenCreate('create', update_rate=60, baud=19200)
    driven.line.baud = 19200
    driven.connect()
    driven.run(3)
    driven.drive(0.2, 0.5, 2)
    queries = driven.driver.queries
    assert queries.missed == queries.rejected == 0


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

    def update(reading, *others):
        if driven.driver.implausible < 2:
            reading = {**reading, 'distance': 5000, 'left_encoder': 30000}
        return travel(reading, *others)
    driven.driver.counter.update = update
    driven.run(0.3)
    assert driven.driver.implausible == 2 and driven.pose == (0, 0, 0)
    assert driven.driver.queries.missed == 2


# commands

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
    byte = 10 * SECOND // driven.driver.contact.baud
    for (before, data), (after, _) in zip(stops, stops[1:]):
        # a query of up to 13 bytes follows the stop; a step of the driver
        assert 0 < after - before - SECOND // 10 - len(data) * byte <= 13 * byte + 2 * SECOND // 500


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
    assert 1.0 <= float(line[len('The robot answers again: it did not answer for '):-len(' s')]) <= 1.6
    assert driven.driver.acceptance.lockout.reason.startswith('the robot did not answer for 1.')
    driven.command_zero()
    driven.drive(0.2, 0, 1)
    driven.robot.switch_on(driven.now)
    driven.run(3)
    assert 'The robot answers again: it was switched off, reset, or silent at rest' in driven.log
    assert driven.driver.acceptance.lockout.reason == 'the robot was switched off, reset, or silent at rest'


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
    assert driven.log == ['Connected to a create2 at 19200 baud', 'The robot is in safe mode']
