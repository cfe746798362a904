"""The steps of the search: rates in turn, two equal replies, the paused stream, and the model from its encoders."""
import pytest

from rbx1_nav.base.units import SECOND
from rbx1_nav.extras.create import protocol, sequences
from rbx1_nav.extras.create.identification import WAKE_TIME, Search, has_frames
from rbx1_nav.extras.create.sender import Phase, Sender

RATES = (57600, 115200, 19200)
MODEL_QUERY = bytes((142, 43, 142, 8))


class Line:
    """Records what a Search does."""

    def __init__(self):
        self.rates, self.sent, self.apart, self.wakes = [], [], [], []

    def set_rate(self, baud):
        self.rates.append(baud)

    def write(self, data):
        self.sent.append(data)

    def write_apart(self, data):
        self.apart.append(data)

    def set_wake_lines(self, on):
        self.wakes.append(on)
        return True


def battery(state=2, voltage=16000, temperature=25):
    """Return the reply to a battery query."""
    packets = protocol.single_packets(protocol.CREATE, [3])
    return protocol.packets_format(packets).pack(state, voltage, -300, temperature, 2000, 3000)


class Searching:
    """A Search whose next step can be awaited."""

    def __init__(self, rates=RATES, baud=None, wake=False):
        self.line, sender, self.now = Line(), Sender(), SECOND
        sender.use_line(self.line.write)
        sender.phase = Phase.SEARCHING
        self.search = Search(sender, rates, wake)
        self.search.begin(self.now, self.line, baud)

    def answer(self, data):
        """Let the robot answer before the next step. Returns the result of that step."""
        self.search.receive(self.now, data)
        return self.step()

    def step(self):
        """Wait for the next step. Returns its result."""
        assert self.search.tick(self.search._deadline - 1) is None
        self.now = self.search._deadline
        return self.search.tick(self.now)

    def find_battery(self):
        """Answer two battery queries."""
        for _ in range(2):
            assert self.line.sent[-1] == sequences.ASK_BATTERY
            self.answer(battery())
        assert self.line.sent[-1] == sequences.PAUSE_STREAM
        self.step()     # the stream has stopped
        assert self.line.sent[-1] == MODEL_QUERY


@pytest.mark.parametrize('baud, order', [
    (None, RATES), (57600, RATES), (115200, (115200, 57600, 19200)), (19200, (19200, 57600, 115200))])
def test_the_rates_are_tried_in_turn_the_expected_one_first(baud, order):
    searching = Searching(baud=baud)
    for _ in range(6):
        assert searching.search.rounds == (len(searching.line.rates) - 1) // 3
        searching.step()
    assert tuple(searching.line.rates) == order * 2 + order[:1] and searching.search.rounds == 2


@pytest.mark.parametrize('wake', [False, True])
def test_a_robot_that_sleeps_is_woken_in_each_round_only_if_that_is_wanted(wake):
    searching, levels = Searching(wake=wake), []    # (number of rates that were tried, level, ns)
    for _ in range(12):
        before = len(searching.line.wakes)
        searching.step()
        levels += [(len(searching.line.rates), level, searching.now) for level in searching.line.wakes[before:]]
    rates, lines, times = zip(*levels) if levels else ((), (), ())
    assert rates == (3, 3, 6, 6)[:4 * wake] and lines == (False, True, False, True)[:4 * wake]
    # both levels last long: three pulses below 500 ms change the robot's rate
    assert all(after - before >= WAKE_TIME > SECOND // 2 for before, after in zip(times, times[1:]))


def test_two_replies_in_a_row_are_required():
    searching = Searching()
    searching.answer(battery())
    assert searching.line.rates == [57600] and searching.line.sent[-1] == sequences.ASK_BATTERY
    searching.answer(battery(voltage=0))
    assert searching.line.rates == [57600, 115200]
    searching.answer(battery())     # the reply at another rate does not count
    assert searching.line.sent[-1] == sequences.ASK_BATTERY and searching.line.rates == [57600, 115200]
    searching.answer(battery())
    assert searching.line.sent[-1] == sequences.PAUSE_STREAM
    assert searching.search._deadline - searching.now == SECOND // 20


@pytest.mark.parametrize('baud, model', [
    (115200, protocol.CREATE_2), (57600, protocol.CREATE), (19200, protocol.CREATE)])
def test_after_four_unclear_replies_the_rate_decides(baud, model):
    searching = Searching((baud,))
    searching.find_battery()
    assert [searching.answer(bytes(size)) for size in (2, 1, 4)] == [None] * 3
    assert searching.answer(bytes(3)) == (model, baud)


@pytest.mark.parametrize('data, found', [
    (b'\x13\x02\x23\x01', False), (b'\x13\x02\x23\x01\xc7', False), (b'\x13\x02\x23\x01\xc7' * 2, True),
    (b'\x13\x02\x23\x01\xc6' + b'\x13\x02\x23\x01\xc7', False), (b'\x13\x02\x23\x01\xc7\x13', False),
    (b'\x13\x00\xed\x13\x00\xed', True), (b'\x14\x00\xec\x14\x00\xec', False)])
def test_frames_of_a_stream(data, found):
    assert has_frames(data) == found
