"""fleet.py adds and removes robots while it runs; each has its parameters, its namespace and its place in the map."""
import pytest
import rospy

from rbx1_nav.base.clocks import Clock
from rbx1_nav.base.units import SECOND
from rbx1_nav.node import life
from rbx1_nav.simulation import simulated_base_node
from fake_topics import Topic
from loaded_nodes import load, without_master

PARAMS = {'controllers': {'base': dict(type='diff_controller', base_width=0.4, rate=10)}, 'surface': 'ideal'}


class Time(Clock):
    """A clock that the test sets."""

    time = 0

    def now(self):
        return self.time

    def stamp(self, instant):
        return rospy.Time(0, instant)


@pytest.fixture(name='fleet')
def fixture_fleet(monkeypatch):
    module = load('fleet')
    topics, log = without_master(monkeypatch)
    monkeypatch.setattr(simulated_base_node, 'Updater', lambda: type('Updater', (), dict(
        dict.fromkeys(('setHardwareID', 'add', 'force_update'), lambda *_: None), publisher=Topic('diagnostics'))))
    stored = {f'/{name}/arbotix': dict(PARAMS) for name in ('robot1', 'robot2', 'a')}
    monkeypatch.setattr(rospy, 'get_param', lambda name, default=None: stored.get(name, default))
    monkeypatch.setattr(module, 'is_alive', lambda name: name == '/a/arbotix')
    monkeypatch.setattr(module, 'param', {'spacing': 1.5}.get)
    fleet = module.Fleet(Time(50))
    fleet.module, fleet.topics, fleet.log, fleet.stored = module, topics, log, stored
    return fleet


def test_each_robot_has_its_namespace_its_frames_and_its_place(fleet):
    assert fleet.add('robot1') == (True, 'robot1: added') and fleet.add('robot2')[0]
    places = fleet.topics['/tf_static'].sent[-1].transforms
    assert [(each.header.frame_id, each.child_frame_id, each.transform.translation.x, each.transform.translation.y)
            for each in places] == [('map', 'robot1/odom', 0, 0), ('map', 'robot2/odom', 0, -1.5)]
    for time in 1, 2, 11:       # tenths of its period, and the next one
        fleet.clock.time = time * SECOND // 100
        fleet.step()
    assert [each.header.frame_id for each in fleet.topics['/robot2/odom'].sent] == ['robot2/odom'] * 2


@pytest.mark.parametrize('name, text', [
    ('robot3', 'no parameters'), ('1x', 'letters, digits'), ('a', 'another node'), ('robot1', 'this robot exists')])
def test_a_robot_that_cannot_be_added(fleet, name, text):
    fleet.add('robot1')
    added, why = fleet.add(name)
    assert not added and why.startswith(f'/{name}/arbotix: ') and text in why and ('err', why) in fleet.log
    assert list(fleet.robots) == ['robot1'] and len(fleet.places) == 1


def test_an_unknown_parameter_is_reported(fleet):
    fleet.stored['/robot1/arbotix']['drag'] = 1
    assert fleet.add('robot1')[0] and ('warn', 'Ignoring unknown parameters: drag') in fleet.log


def test_the_services_add_and_remove_in_the_thread_of_the_clock(fleet, monkeypatch):
    monkeypatch.setattr(life, 'sleep', lambda _: fleet.step())
    fleet.serve()
    added = fleet.topics['~add'].callback(type('Request', (), {'load_namespace': '/robot2/'}))
    assert (added.success, added.message) == (True, 'robot2: added') and list(fleet.robots) == ['robot2']
    removed = fleet.topics['~remove'].callback(type('Request', (), {'load_namespace': 'robot2'}))
    assert removed.success and not fleet.robots
    assert fleet.remove('robot2') == (False, 'robot2: expected one of no robots')


def test_an_error_of_the_master_does_not_stop_the_clock(fleet, monkeypatch):
    def fail(_):
        raise rospy.ROSException('no master')
    monkeypatch.setattr(life, 'sleep', lambda _: fleet.step())
    assert fleet.request(fail, 'b') == (False, 'b: no master')


def test_a_request_during_shutdown_is_answered(fleet, monkeypatch):
    monkeypatch.setattr(life.end_requested, 'is_set', lambda: True)
    assert fleet.request(fleet.remove, 'b') == (False, 'the node is shutting down')


@pytest.mark.parametrize('number, status', [(2, 0), (3, 1)])
def test_the_robots_at_the_start(fleet, monkeypatch, number, status):
    ran = []
    monkeypatch.setattr(fleet.module, 'param', {'spacing': 1.0, 'robots': float(number), 'rate': 50.0}.get)
    monkeypatch.setattr(Time, 'run', lambda _, step: ran.append(step))
    monkeypatch.setattr(fleet.module, 'read_clock', Time)
    assert fleet.module.main() == status and len(ran) == 1 - status
    assert (('info', 'Ready: 2 robots') in fleet.log) == (status == 0)
