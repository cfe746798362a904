"""Robots that are exchanged, disturbed or blocked."""
from rbx1_nav.extras.create import sequences

from driven_create import BOTH, DrivenCreate, started


@BOTH
def test_a_bump_stops_the_robot_at_once_is_refused_later_and_no_longer_than_it_lasts(robot_type):
    driven = started(robot_type)
    driven.drive(0.2, 0, 0.5)
    driven.body.bumped = True
    driven.drive(0.2, 0, 0.1)
    assert driven.speeds == (0, 0) and not driven.refusals
    driven.drive(0.2, 0, 0.4)
    assert set(driven.refusals) == {'a bumper is pressed'}
    count = len(driven.refusals)
    driven.drive(-0.2, 0, 0.5)
    driven.body.bumped = False
    driven.run(0.1)
    driven.drive(0.2, 0, 0.5)
    assert driven.speeds == (200, 200) and len(driven.refusals) == count


def test_another_robot_at_another_adapter_gets_no_command_before_it_is_known():
    driven = started('auto', robot='create')
    driven.pull()
    other = DrivenCreate('auto', robot='create2')
    driven.line, driven.robot, driven.body = other.line, other.robot, other.body
    driven.is_same = False
    driven.run(1)
    driven.connect()
    driven.run(2)
    assert {data for _, data in other.commands} <= {sequences.START, b'\x8e\x03', b'\x8e\x2b', b'\x8e\x08', b'\x96\x00'}
    assert not other.robot.programs_started
    assert driven.log[-1] == ('A create2 answers at 115200 baud: expected a create; to drive it, restart this node '
                              'with robot_type:=create2, or auto')
