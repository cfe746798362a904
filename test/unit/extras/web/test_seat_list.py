"""The list of seats, for the page of the teacher only."""
import json

import pytest

from rbx1_nav.extras.web.access import Access
from rbx1_nav.extras.web.seat import Seat
from rbx1_nav.extras.web.seat_list import MAX_SILENT, SeatList


class Socket:
    """Takes the place of tornado's handler: keeps what it sends."""

    def __init__(self):
        self.sent, self.closed = [], False

    def write_message(self, message):
        self.sent.append(json.loads(message))

    def close(self):
        self.closed = True


@pytest.fixture(name='seats')
def make_seats():
    return [Seat(number, 0, 'localhost', 9000 + number, 9000, [], print) for number in (1, 2)]


@pytest.fixture(name='seat_list')
def make_list(seats):
    return SeatList(Access('of the teacher', 'code'), seats)


def answer(seat_list, text):
    """The answers to a message of a new browser, which is then disconnected."""
    socket = Socket()
    seat_list.opened(socket)
    seat_list.received(socket, text)
    assert socket.closed
    seat_list.closed(socket)
    return socket.sent


def hello(**fields):
    return json.dumps({'type': 'hello', **fields})


def test_a_code_gives_the_seats_once_and_a_token_always(seat_list, seats):
    expected = [{'type': 'welcome', 'token': 'of the teacher', 'seats': [
        {'number': 1, 'port': 9001, 'token': seats[0].token}, {'number': 2, 'port': 9002, 'token': seats[1].token}]}]
    assert answer(seat_list, hello(code='code')) == expected
    for _ in range(2):
        assert answer(seat_list, hello(token='of the teacher')) == expected
    assert answer(seat_list, hello(code='code')) == [{'type': 'welcome', 'token': '', 'seats': []}]


def test_nobody_else_gets_the_seats(seat_list, seats):
    for text in hello(), hello(token='x', code='x'), hello(token=seats[0].token):
        assert answer(seat_list, text) == [{'type': 'welcome', 'token': '', 'seats': []}]
    for text in '', 'x', json.dumps({'type': 'stop'}), hello(code=5):
        assert answer(seat_list, text) == []


def test_browsers_that_send_nothing_do_not_pile_up(seat_list):
    sockets = [Socket() for _ in range(MAX_SILENT + 2)]
    for each in sockets:
        seat_list.opened(each)
    assert [each.closed for each in sockets] == 2 * [True] + MAX_SILENT * [False]
    for each in sockets:
        seat_list.closed(each)
    assert not seat_list.browsers
