"""The robot docks by itself until something ends it, and is driven off its dock in full mode, with a look at cliffs and
wheel drops."""
import pytest

from rbx1_nav.base.command_gate import RefusedCommand
from rbx1_nav.extras.create.protocol import FULL, OFF, PASSIVE, SAFE, WHEEL_DROP_RIGHT, command

from driven_create import BOTH, started


def docking(robot_type):
    """Return a robot that is looking for its dock."""
    driven = started(robot_type)
    driven.driver.orders.dock(driven.now)
    driven.run(1)
    assert driven.robot.program_runs and driven.robot.mode == PASSIVE and driven.body.moving
    return driven


def on_dock(robot_type, **params):
    """Return a robot that stands on its dock."""
    driven = started(robot_type, **params)
    driven.body.docked = True
    driven.run(2)
    return driven


def undock(driven):
    driven.driver.orders.undock(driven.now)


def undocking(robot_type):
    """Return a robot that has begun to move on its dock."""
    driven = on_dock(robot_type)
    undock(driven)
    while not driven.body.moving:
        driven.run(0.01)
    assert driven.robot.mode == FULL and driven.body.docked
    return driven


def modes(driven, seconds):
    """Run; return the modes of the robot in this time, in order, and how long (s) it was in each."""
    found, times = [driven.robot.mode], [0.0]
    for _ in range(round(100 * seconds)):
        driven.run(0.01)
        if driven.robot.mode != found[-1]:
            found.append(driven.robot.mode)
            times.append(0.0)
        times[-1] += 0.01
    return found, times


@BOTH
def test_the_robot_docks_and_charges(robot_type):
    driven = docking(robot_type)
    driven.run(5)
    # the driver leaves it alone
    supervisor = driven.driver.supervisor
    assert driven.robot.program_runs and supervisor.reason == 'docking' and not supervisor.in_control
    # one corrupted reading is no dock
    driven.driver.orders.update(driven.now, dict(driven.driver.reading, charging_sources=2), 0.0)
    driven.run(1)
    assert driven.robot.program_runs and driven.driver.orders.state
    driven.body.docked = True
    assert modes(driven, 5)[0] == [PASSIVE]
    assert not driven.body.moving and 'The robot is on its dock' in driven.log and not driven.driver.orders.state
    assert driven.driver.reading['charging_state']


def plug_in_again(driven):
    driven.pull()
    driven.run(2)
    driven.connect()
    driven.run(2)


def command_zero(driven):
    driven.command(0.0, 0.0, sender='/teleop')


def command_motion(driven):
    driven.command(-0.1, 0.0, sender='/teleop')


def stop(driven):
    driven.driver.stop(driven.now, 'the guardian process died')


def halt(driven):
    """As a stall of the node does."""
    driven.gate.halt()


def senses(name, bits):
    return lambda driven: setattr(driven.body, name, bits)


@BOTH
@pytest.mark.parametrize('begin, end, text', [
    *((begin, *each) for begin in (docking, undocking)
      for each in ((command_zero, 'a command from /teleop'), (stop, 'the guardian'))),
    (docking, command_motion, 'a command from /teleop'), (docking, plug_in_again, 'it did not answer'),
    (undocking, halt, 'it was stopped'), (undocking, senses('switches', WHEEL_DROP_RIGHT), 'a wheel dropped'),
    (undocking, senses('cliffs', 1), 'a cliff'), (undocking, senses('cliffs', 8), 'a cliff')])
def test_what_ends_docking_and_undocking(robot_type, begin, end, text):
    driven = begin(robot_type)
    end(driven)
    driven.run(0.1)
    assert not driven.robot.program_runs and not driven.driver.orders.state
    assert any(f'no longer {begin.__name__}: {text}' in line for line in driven.log), driven.log
    if begin is docking:
        driven.drive(-0.1, 0.0, 0.5)
        assert driven.robot.mode == SAFE and (driven.speeds == (-100, -100) or end in (stop, plug_in_again))
        return
    for seconds in 0, 3:        # on its dock, it remains where it is, and charges
        driven.run(seconds)
        assert not driven.body.moving and driven.robot.mode == PASSIVE
        driven.body.switches = driven.body.cliffs = 0
    assert driven.driver.reading['charging_state']


@BOTH
@pytest.mark.parametrize('begin, lost', [
    *((docking, lost) for lost in (0, 1, 9, 14, 15, 17, 18)), (undocking, 0), (undocking, 14)])
def test_the_exit_ends_both_even_if_the_first_bytes_of_the_stop_are_lost(robot_type, begin, lost):
    driven = begin(robot_type)
    driven.losing = lost
    driven.driver.leave(driven.now)
    for _ in range(200):
        if not driven.driver.left:
            driven.run(0.002)
    assert driven.driver.left and not driven.body.moving and driven.robot.mode == PASSIVE
    with pytest.raises(RefusedCommand, match='shutting down'):
        driven.driver.orders.dock(driven.now)


@BOTH
def test_an_order_to_dock_that_was_lost_is_repeated(robot_type):
    driven = started(robot_type)
    write, driven.driver.sender.write = driven.driver.sender.write, lambda data: None
    driven.driver.orders.dock(driven.now)
    driven.driver.sender.write = write
    driven.run(1)
    assert driven.robot.program_runs and driven.robot.programs_started == 1
    driven.run(3)
    assert driven.robot.program_runs and driven.robot.programs_started == 1
    # a new order starts it again
    driven.driver.orders.dock(driven.now)
    driven.run(3)
    assert driven.robot.program_runs


@BOTH
@pytest.mark.parametrize('mode', [SAFE, FULL])
def test_the_robot_leaves_its_dock_in_full_mode(robot_type, mode):
    driven = on_dock(robot_type, operation_mode=mode)
    undock(driven)
    x = driven.truth.x
    found, times = modes(driven, 6)
    if mode == SAFE:
        assert found == [PASSIVE, FULL, SAFE]
        # no wait, as after a wheel drop; then 2 cm at 0.1 m/s, three readings until it moves, and three until it is
        # seen to have left
        assert times[0] < 0.3 and times[1] < 0.2 + 6 / 30
    assert driven.robot.mode == mode and not driven.body.moving
    # it stops after the reading that shows 0.2 m: two periods at 0.1 m/s
    assert driven.truth.x - x == pytest.approx(-0.2, abs=0.01)
    assert driven.log[-1] == 'The robot has left its dock'
    driven.drive(0.1, 0.0, 0.5)
    assert driven.speeds == (100, 100) and not driven.refusals


@BOTH
def test_one_reading_without_contact_does_not_end_full_mode(robot_type):
    driven = undocking(robot_type)
    state = driven.driver.orders.state
    driven.driver.orders.update(driven.now, dict(driven.driver.reading, charging_sources=0), 0.0)
    assert driven.driver.orders.state == state
    driven.run(0.05)
    assert driven.robot.mode == FULL and driven.body.docked and driven.body.moving


@BOTH
def test_a_program_that_was_started_by_a_button_is_replaced(robot_type):
    driven = started(robot_type)
    driven.robot.receive(command('cover'), driven.now)
    driven.run(0.1)
    driven.driver.orders.dock(driven.now)
    driven.run(2)
    assert driven.robot.program_runs and driven.robot.programs_started == 2


@BOTH
def test_an_old_order_does_not_move_the_robot_after_an_outage(robot_type):
    driven = on_dock(robot_type)
    undock(driven)
    driven.line.silent = True
    driven.run(1.5)
    driven.line.silent = False
    driven.commands.clear()
    driven.run(4)
    assert driven.driver.contact.answers and not driven.driver.orders.state
    assert not driven.body.moving and command('full') not in [data for _, data in driven.commands]


def test_wheels_that_are_blocked_on_the_dock():
    driven = on_dock('create2')
    undock(driven)
    driven.body.wheels.travel = lambda *_: (0.0, 0.0)
    assert modes(driven, 7)[0] == [PASSIVE, FULL, PASSIVE]
    assert any('has not driven 0.2 m in 5 s' in line for line in driven.log)


@BOTH
@pytest.mark.parametrize('order, attribute, value, text', [
    ('dock', 'docked', True, 'the robot is on its dock'), ('dock', 'cliffs', 1, 'a cliff'),
    ('undock', 'docked', False, 'not on its dock'), ('undock', 'charger', True, 'the charger is plugged in'),
    ('undock', 'switches', 16, 'a wheel dropped')])
def test_an_order_that_cannot_be_followed(robot_type, order, attribute, value, text):
    if robot_type == 'create2' and value == 16:     # it has no caster bit
        value = 8
    driven = started(robot_type)
    setattr(driven.body, attribute, value)
    driven.run(1)
    with pytest.raises(RefusedCommand, match=text):
        getattr(driven.driver.orders, order)(driven.now)
    driven.run(1)
    assert not driven.robot.program_runs and not driven.body.moving


def test_no_robot_and_passive_mode():
    driven = started('create2', operation_mode=1)
    with pytest.raises(RefusedCommand, match='operation_mode: 1'):
        driven.driver.orders.dock(driven.now)
    driven = started('create2')
    driven.line.silent = True
    driven.run(1)
    for order in driven.driver.orders.dock, driven.driver.orders.undock:
        with pytest.raises(RefusedCommand, match='does not answer'):
            order(driven.now)
    assert driven.robot.mode != OFF
