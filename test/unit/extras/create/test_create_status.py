"""/diagnostics reports the status of each type of robot."""
from types import SimpleNamespace

from diagnostic_updater import DiagnosticStatusWrapper
import pytest
import rospy

from driven_create import DrivenCreate, started
from rbx1_nav.extras.create.create_status import ERROR, OK, WARN, CreateStatus, battery_status


def statuses(driven):
    """Return {title: DiagnosticStatus} of a DrivenCreate."""
    functions = {}
    updater = SimpleNamespace(setHardwareID=lambda _: None, add=functions.__setitem__, force_update=lambda: None)
    link = SimpleNamespace(path='/dev/ttyUSB0', problem='', adapter='', baud=driven.driver.contact.baud)
    status = CreateStatus(updater, driven.driver, link, SimpleNamespace(diagnose=lambda _: None))
    status.update()
    return {title: function(DiagnosticStatusWrapper()) for title, function in functions.items()}


@pytest.mark.parametrize('robot, baud', [('create', 57600), ('create2', 115200), ('create2', 19200)])
def test_each_robot_has_a_status_at_each_rate(robot, baud):
    driven = DrivenCreate(robot, baud=baud)
    driven.line.baud = baud
    driven.connect()
    driven.run(3)
    found = statuses(driven)
    values = {each.key: each.value for each in found['Base'].values}
    assert found['Base'].message == 'Stationary' and values['Robot type'] == robot
    # only a Create may lose fractions of a degree
    assert ('Fractions of a degree' in values) == ('Gyro' in found) == (robot == 'create')


NO_ANSWER = ERROR, 'The robot does not answer'


@pytest.mark.parametrize('attribute, value, expected', [
    ('switches', 3, {'Base': (OK, 'Stationary'), 'Sensors': (WARN, 'bumper')}),
    ('switches', 8, {'Base': (WARN, 'Not driven: a wheel dropped'), 'Sensors': (WARN, 'wheel drop')}),
    ('cliffs', 6, {'Base': (WARN, 'Not driven: a cliff'),
                 'Sensors': (WARN, 'cliff front left, cliff front right')}),
    ('docked', True, {'Base': (WARN, 'Not driven: on the dock: publish on undock, or lift it off'),
                      'Battery': (OK, 'trickle charging')}),
    ('gyro_stuck', 12, {'Base': (OK, 'Stationary'), 'Gyro': (
        ERROR, '12 counts: expected at least 100: does it have power?')}),
    ('charge', 450, {'Base': (OK, 'Stationary'), 'Battery': (WARN, 'Low: 15 %')}),
    ('charge', 0, {'Base': NO_ANSWER, 'Battery': NO_ANSWER, 'Sensors': NO_ANSWER, 'Serial line': (ERROR, 'Open')})])
def test_a_problem_of_the_robot_is_reported(monkeypatch, attribute, value, expected):
    lines = []
    monkeypatch.setattr(rospy, 'logwarn', lambda form, *values: lines.append(form % values))
    driven = started('create', 2.5)
    setattr(driven.body, attribute, value)
    driven.drive(0.1 if attribute == 'cliffs' else 0.0, 0.0, 0.3)
    driven.run(1)
    found = statuses(driven)
    assert {title: (found[title].level, found[title].message) for title in expected} == expected
    assert lines == (['Battery: Low: 15 %: charge it soon'] if value == 450 else [])


@pytest.mark.parametrize('changes, level, text', [
    ({}, OK, '100 %'),
    ({'charging_state': 2, 'charging_sources': 2, 'charge': 30}, OK, 'charging'),
    ({'charging_state': 5, 'charging_sources': 2}, ERROR, 'charging fault'),
    ({'charge': 30}, ERROR, 'Low: 1 %'), ({'charge': 30, 'voltage': 9500}, ERROR, 'Low: 1 %'),
    ({'charge': 30, 'charging_sources': 2}, ERROR, 'Low: 1 %'),     # on the dock, but not charging
    ({'charge': 5010}, WARN, '167 %: expected at most 110 %'),
    ({'temperature': 75}, ERROR, '75 degrees C: expected at most 60'),
    ({'charge': 2490, 'voltage': 9500}, WARN, '9.5 V: expected at least 10.8 V'),
])
def test_a_bad_battery_is_reported(changes, level, text):
    reading = {'charging_state': 0, 'charging_sources': 0, 'charge': 3000, 'capacity': 3000, 'temperature': 25,
               'voltage': 16000, 'current': -300}
    assert battery_status({**reading, **changes}) == (level, text)
