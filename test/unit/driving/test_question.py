"""A question on the terminal handles invalid answers, a missing terminal, and a shutdown request."""
import os
import threading

import pytest
import rospy

from rbx1_nav.driving import calibration_script as question
from rbx1_nav.node.config import ConfigError


def check(text):
    """Check an answer; only 'right' is accepted."""
    if text != 'right':
        raise ConfigError(f'{text}: expected right')
    return text


@pytest.fixture(name='terminal')
def fixture_terminal(monkeypatch):
    """Return a file descriptor; text written to it appears as typed input."""
    read_end, write_end = os.pipe()
    with os.fdopen(read_end) as source:
        monkeypatch.setattr(question.sys, 'stdin', source)
        monkeypatch.setattr(question, 'end_requested', threading.Event())
        yield write_end
    try:
        os.close(write_end)
    except OSError:     # closed by the test
        pass


def test_it_asks_until_the_answer_makes_sense(terminal, capsys):
    os.write(terminal, b'wrong\n\n  right \nmore\n')
    assert question.ask('What?', check) == 'right'
    assert capsys.readouterr().out == 'What? wrong: expected right\nWhat? : expected right\nWhat? '


def test_without_an_answer_it_ends(terminal, capsys):
    os.write(terminal, b'no line')
    os.close(terminal)
    assert question.ask('What?', check) is None and capsys.readouterr().out == 'What? \n'
    question.end_requested.set()
    with pytest.raises(rospy.ROSInterruptException):
        question.ask('What?', check)
    assert capsys.readouterr().out == 'What? \n'
