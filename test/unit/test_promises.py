"""Each promise of docs/reliability.md has a test; test/promises.md lists them."""
import os
import sys

sys.path.insert(0, os.path.join(os.path.dirname(__file__), '..', '..', 'script'))
import promises        # noqa: E402    found by the line above


def test_each_promise_has_a_test():
    assert promises.troubles() == []


def test_the_page_is_up_to_date():
    assert promises.page() == promises.read(promises.PAGE), 'run script/promises.py'


def test_what_is_missing_is_named(monkeypatch):
    held = promises.promises()
    held['The robot flies'] = ['driving/flight.test']
    held['An outage has no effect'] = []
    del held['A gyro without power']
    monkeypatch.setattr(promises, 'promises', lambda: held)
    found = promises.troubles()
    for text in ("'The robot flies': expected a phrase", "'The robot flies': driving/flight.test: no such test",
                 "'An outage has no effect': expected a test", '**A gyro without power** is reported'):
        assert [line for line in found if text in line], (text, found)
