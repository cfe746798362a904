"""What can be chosen in the page: only what is allowed, known and in range, and not while the robot is driven."""
import pytest

from rbx1_nav.extras.web.choices import CHOICES, read_choice, read_choices
from rbx1_nav.node.config import ConfigError
from test_connections import TOKEN, View

SURFACES = ['ideal', 'sand']


@pytest.mark.parametrize('text, names', [
    ('none', []), ('seed', ['seed']), ('surface, speed', ['surface', 'speed']), (','.join(CHOICES), list(CHOICES))])
def test_the_teacher_chooses_what_can_be_chosen(text, names):
    assert read_choices(text) == names


@pytest.mark.parametrize('text', ['', 'color', 'surface;seed', 5, 'none,seed'])
def test_other_names_are_rejected(text):
    with pytest.raises(ConfigError, match='expected none, or some of surface,seed,distance,speed'):
        read_choices(text)


@pytest.mark.parametrize('name, text, value', [
    ('surface', 'sand', 'sand'), ('seed', '0', '0'), ('seed', 'random', 'random'), ('seed', '123456789', '123456789'),
    ('distance', '0.75', 0.75), ('distance', '3', 3.0), ('speed', '0.05', 0.05)])
def test_a_value(name, text, value):
    assert read_choice(name, text, SURFACES) == value


@pytest.mark.parametrize('name, text', [
    ('surface', '/etc/passwd'), ('surface', ''), ('seed', '-1'), ('seed', '1.5'), ('seed', '1234567890'), ('seed', '٣'),
    ('distance', '3.01'), ('distance', '1e0'), ('distance', 'nan'), ('speed', '0.04'), ('speed', ''), ('speed', '.2')])
def test_other_values_are_rejected(name, text):
    with pytest.raises(ValueError, match='expected'):
        read_choice(name, text, SURFACES)


@pytest.fixture(name='view')
def make_view():
    view = View()
    view.system.choices, view.system.surfaces = ['surface', 'distance'], SURFACES
    view.system.choose = lambda *choice: view.system.calls.append(choice)
    return view


def refusals(view, token=TOKEN, **message):
    socket = view.connect(token)
    view.send(socket, type='choose', **message)
    return [each['reason'] for each in socket.messages if each['type'] == 'refused']


def test_another_floor_needs_a_reset(view):
    assert not refusals(view, name='surface', value='sand')
    assert view.system.calls == [('surface', 'sand'), 'reset']


def test_a_distance_does_not(view):
    assert not refusals(view, name='distance', value='0.5')
    assert view.system.calls == [('distance', 0.5)]


def test_what_is_refused(view):
    assert 'cannot be chosen' in refusals(view, name='seed', value='7')[0]
    assert 'surface: expected one of ideal, sand' in refusals(view, name='surface', value='snow')[0]
    assert 'cannot drive' in refusals(view, '', name='surface', value='sand')[0]
    view.runs.busy = True
    assert 'in progress' in refusals(view, name='surface', value='sand')[0]
    assert not view.system.calls
