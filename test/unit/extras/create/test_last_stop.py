"""The robot must confirm the last stop if it may still move."""
import pytest

from rbx1_nav.extras.create import protocol

from driven_create import BOTH, started

STOP = protocol.drive_direct(0, 0)


@BOTH
@pytest.mark.parametrize('lost', [0, 12, 16, 60])
@pytest.mark.parametrize('rate', [0, 10, 20, 50, 200])
def test_after_the_last_stop_a_sender_does_not_move_the_robot(robot_type, rate, lost):
    """rate: of a sender that continues, Hz; lost: number of bytes, from the first one of the stop on."""
    driven = started(robot_type)
    driven.rate = rate or 50
    driven.drive(0.2, 0, 0.5)
    driven.velocity = (0.2, 0) if rate else None
    count, driven.losing = len(driven.commands), lost
    driven.driver.leave(driven.now)
    assert not driven.driver.left
    driven.run(0.3)
    assert driven.speeds == (0, 0)
    driven.run(0.3)
    assert driven.driver.left and driven.robot.mode == protocol.PASSIVE and driven.speeds == (0, 0)
    after = [data for _, data in driven.commands[count:]]
    stop = next(index for index, data in enumerate(after) if data in (STOP, protocol.command('start')))
    assert not [data for data in after[stop:] if data[0] == STOP[0] and data != STOP]


@BOTH
@pytest.mark.parametrize('garbage', [b'\x8c\x00\xff', b'\x94\xff'], ids=['song', 'stream'])
def test_the_last_stop_and_a_stop_after_a_reconnection_hold_after_garbage(robot_type, garbage):
    last, connected = started(robot_type), started(robot_type)
    for driven in last, connected:
        driven.drive(0.2, 0, 0.5)
        driven.write(garbage)
    last.driver.leave(last.now)
    connected.pull()
    connected.run(0.5)
    connected.connect()
    for driven in last, connected:
        driven.run(0.3)
        assert driven.speeds == (0, 0)
    assert last.driver.left and connected.driver.contact.answers


@BOTH
@pytest.mark.parametrize('drives', [False, True])
def test_only_a_robot_that_may_still_move_must_confirm_the_last_stop(robot_type, drives):
    driven = started(robot_type)
    if drives:
        driven.drive(0.2, 0, 0.5)
    driven.line.silent = True
    driven.run(1.5)
    driven.driver.leave(driven.now)
    driven.run(0.6)
    assert driven.driver.left == (not drives) and driven.body.moving == drives
