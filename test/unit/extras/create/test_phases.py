"""What may be sent in each phase of the contact with a robot."""
import pytest

from rbx1_nav.extras.create.sender import MAY_SEND, Kind, Phase, Sender


@pytest.mark.parametrize('phase', Phase)
def test_only_what_the_table_allows_is_sent(phase):
    sender, sent = Sender(), []
    sender.use_line(sent.append)
    sender.phase = phase
    for kind in Kind:
        sender.send(0, kind, kind.name.encode())
    assert {data.decode() for data in sent} == {kind.name for kind in MAY_SEND[phase]}
    sent.clear()
    sender.drive(0, (100, 100))
    assert bool(sent) == any(sender.speeds) == (phase is Phase.DRIVEN)


def test_before_the_robot_is_known_only_the_search_sends_and_after_the_last_stop_nothing_moves_it():
    assert MAY_SEND[Phase.SEARCHING] == {Kind.SEARCH} and not any(
        Kind.SEARCH in kinds for phase, kinds in MAY_SEND.items() if phase is not Phase.SEARCHING)
    assert MAY_SEND[Phase.LEAVING] == {Kind.STOP, Kind.QUERY} and not MAY_SEND[Phase.LEFT]
