"""When a silent robot is stopped, started and searched for, and what is logged. All times are in milliseconds."""
from types import SimpleNamespace

import pytest

from rbx1_nav.create import protocol
from rbx1_nav.create.driver import sequences
from rbx1_nav.create.driver.contact import Contact, Event
from rbx1_nav.create.driver.parameters import read_settings
from rbx1_nav.create.driver.search import Found
from rbx1_nav.units import SECOND

MS = SECOND // 1000
CREATE, CREATE_2 = Found(protocol.CREATE, 57600), Found(protocol.CREATE_2, 19200)


class Contacted:
    """A Contact whose driver and line record what happens; `found` is what the search finds next."""

    is_same = True

    def __init__(self, **params):
        self.events, self.log = [], []
        sender = SimpleNamespace(stop=lambda now: self.events.append('stop'))
        queries = SimpleNamespace(give_up=lambda: None,
                                  ask=lambda now, start: self.events.append('start' if start else 'ask'))
        supervisor = SimpleNamespace(forget=lambda: self.events.append('lost'), restart=lambda now: None)
        self.contact = Contact(read_settings(params)[0], sender, queries, supervisor, self.log.append)
        self.search = self.contact.search = SimpleNamespace(
            battery_rates=[],
            begin=lambda now, line, baud: self.events.append(f'search {baud}'), tick=lambda now: self.found, rounds=0,
            rates=(57600, 19200), begin_later=lambda now, wait: self.events.append(f'search in {wait // MS}'))
        self.found = None

    # the interface of the line

    def confirm(self, found):
        self.events.append(f'confirm {found.model.name}')

    def set_rate(self, baud):
        self.events.append(f'rate {baud}')

    def write(self, data):
        assert data == sequences.FLUSH
        self.events.append('flush')

    # the test

    def tick(self, milliseconds, reading=None):
        """Return the events of a tick. reading: time of the last reading."""
        self.events.clear()
        event = self.contact.tick(milliseconds * MS, None if reading is None else reading * MS)
        if event is Event.FOUND:
            self.contact.start(milliseconds * MS)
        return list(self.events)

    def attach(self, milliseconds):
        """Return the events of a line that is opened."""
        self.events.clear()
        self.contact.attach(milliseconds * MS, self)
        return list(self.events)


def answering(found=CREATE, **params):
    """Return a Contacted whose robot was found at 0 and answers."""
    contacted = Contacted(**params)
    contacted.attach(0)
    contacted.found = found
    contacted.tick(0)
    assert contacted.contact.hear() and not contacted.contact.hear()
    return contacted


def test_a_robot_that_was_found_is_started_and_searched_for_again_after_a_second():
    contacted = Contacted()
    assert contacted.attach(0) == ['search 57600'] and not contacted.contact.may_ask
    contacted.found = CREATE
    assert contacted.tick(0) == ['confirm create', 'stop', 'start']
    assert contacted.contact.started and contacted.contact.may_ask
    assert contacted.tick(1000) == [] and contacted.tick(1001) == ['search 57600']


def test_silence_for_half_a_second():
    contacted = answering()
    assert contacted.tick(1500, 1000) == [] and contacted.contact.answers
    assert contacted.tick(1501, 1000) == ['lost', 'rate 57600', 'stop', 'ask']
    assert not contacted.contact.answers and contacted.contact.dropouts == 1 and len(contacted.log) == 1
    # after 0.1 s, garbage may have swallowed the stop; after 0.3 s, the robot is started; 1 s later, it is searched for
    assert contacted.tick(1601) == [] and contacted.tick(1602) == ['flush', 'stop', 'ask']
    assert contacted.tick(1603) == []
    assert contacted.tick(1801) == [] and contacted.tick(1802) == ['stop', 'start']
    assert contacted.tick(2802) == [] and contacted.tick(2803) == ['search 57600']
    assert contacted.contact.dropouts == 1


def test_each_silence_is_flushed_and_counted():
    contacted = answering()
    for silence in 1, 2:
        time = 10000 * silence
        contacted.tick(time, time - 501)
        assert 'flush' in contacted.tick(time + 101)
        contacted.tick(time + 301)
        assert contacted.contact.hear() and not contacted.contact.started
        assert contacted.contact.dropouts == silence == len(contacted.log)


def test_a_line_that_comes_back_gets_a_stop():
    contacted = answering(CREATE_2)
    contacted.contact.detach()
    assert not contacted.contact.answers and contacted.contact.dropouts == 1 and not contacted.contact.may_ask
    assert contacted.tick(5000) == []
    assert contacted.attach(6000) == ['confirm create2', 'rate 19200', 'stop', 'ask']
    assert contacted.tick(6100) == [] and contacted.tick(6101) == ['flush', 'stop', 'ask']
    contacted.contact.detach()
    assert contacted.contact.dropouts == 1      # it had not answered in between


def test_a_line_that_comes_back_during_the_search_ends_it():
    contacted = answering()
    contacted.tick(2000, 0)
    contacted.tick(2301)
    assert contacted.tick(3302) == ['search 57600'] and contacted.contact.searching
    contacted.contact.detach()
    contacted.found = None
    assert 'ask' in contacted.attach(6000) and not contacted.contact.searching and contacted.contact.may_ask


def test_bytes_that_arrive_during_the_search_are_passed_on():
    contacted, received = Contacted(), []
    contacted.search.receive = lambda now, data: received.append((now, data))
    contacted.contact.receive(7, b'x')
    assert received == [(7, b'x')]


def test_before_a_line_is_open_nothing_answers():
    contacted = Contacted()
    contact = contacted.contact
    assert not (contact.answers or contact.started or contact.searching or contact.may_ask or contacted.tick(10 ** 6))
    contact.detach()
    assert contact.dropouts == 0


def test_another_adapter_is_searched_at_the_rate_of_the_last_robot_first():
    contacted = answering(CREATE_2)
    contacted.is_same = False
    assert contacted.attach(6000) == ['search 19200'] and contacted.contact.searching


def test_a_robot_of_the_wrong_type():
    contacted = Contacted(robot_type='create')
    contacted.attach(0)
    contacted.found = CREATE_2
    text = 'robot_type: create: a create2 answers at 19200 baud: expected robot_type:=create2, or auto'
    for _ in range(3):
        assert contacted.tick(0) == ['search in 1000']
        assert contacted.log == [text] and not contacted.contact.may_ask
    contacted.found = CREATE
    assert contacted.tick(0)[0] == 'confirm create'
    # another robot on another adapter, and a second time after the right one
    contacted.is_same = False
    for count in 2, 3:
        contacted.attach(0)
        contacted.found = CREATE_2
        contacted.tick(0)
        assert contacted.log[count - 1:] == [
            'A create2 answers at 19200 baud instead of a create: restart this node to drive it']
        contacted.found = CREATE
        contacted.tick(0)


@pytest.mark.parametrize('rounds, known, warned', [(1, False, False), (2, False, True), (2, True, False)])
def test_a_warning_after_two_rounds_without_any_robot(rounds, known, warned):
    contacted = answering() if known else Contacted()
    contacted.is_same, contacted.found = False, None
    contacted.attach(0)
    for contacted.search.rounds in (0, rounds):
        contacted.tick(0)
    assert contacted.log == ['No robot answers at 57600, 19200 baud: expected a Create, Create 2 or Roomba that is '
                             'switched on and connected'] * warned
    contacted.attach(0)
    contacted.tick(0)
    assert len(contacted.log) == warned


def test_the_rates_of_the_search():
    assert Contact(read_settings({})[0], None, None, None, print).search.rates == (57600, 115200, 19200)
    search = Contact(read_settings({'baud': 9600, 'wake_robot': True})[0], None, None, None, print).search
    assert search.rates == (9600,) and search.wake
