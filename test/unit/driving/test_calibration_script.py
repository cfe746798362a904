"""The calibration scripts drive a leg to rest, read what the base reports, and know its factors."""
from types import SimpleNamespace

from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus, KeyValue
import pytest
import rospy

from rbx1_nav.driving import calibration_script as module
from rbx1_nav.node.config import ConfigError


def test_a_leg_is_driven_in_parts_with_a_rest_after_each(monkeypatch):
    done, speeds, shutdown = [], iter([0.3, 0.2, 0.0, 0.1, 0.0, 0.0]), []
    monkeypatch.setattr(rospy, 'Publisher', lambda *_, **__: SimpleNamespace(
        publish=lambda twist: done.append((twist.linear.x, twist.angular.z))))
    monkeypatch.setattr(rospy, 'Rate', lambda hz: SimpleNamespace(sleep=lambda: done.append(hz)))
    monkeypatch.setattr(rospy, 'sleep', done.append)
    monkeypatch.setattr(rospy, 'on_shutdown', shutdown.append)
    leg = SimpleNamespace(rests=[0.5, 1.5], velocity=lambda speed: (speed, -2 * speed),
                          next_speed=lambda pose: done.append(pose) or next(speeds))
    publisher = module.make_publisher()
    module.drive(leg, SimpleNamespace(pose=lambda: 'pose'), publisher, 25)
    assert done == ['pose', (0.3, -0.6), 25, 'pose', (0.2, -0.4), 25, 'pose', (0, 0), 0.5,
                    'pose', (0.1, -0.2), 25, 'pose', (0, 0), 1.5, 'pose']
    shutdown[0]()
    assert done[16:17] == [(0, 0)]      # then it waits


def test_the_last_status_of_one_part_of_the_base(monkeypatch):
    receive = []
    monkeypatch.setattr(rospy, 'Subscriber', lambda topic, _, function: receive.append(function))
    gyro = module.Diagnosis('turtlebot_node', 'Gyro')
    assert gyro.value('bias') is None and gyro.error == ''
    for level, part in (DiagnosticStatus.ERROR, 'Gyro'), (DiagnosticStatus.WARN, 'Base'):
        receive[0](DiagnosticArray(status=[
            DiagnosticStatus(level, f'turtlebot_node: {part}', f'text of {part}', '', [
                KeyValue('rate', '1'), KeyValue('bias', part)])]))
        assert gyro.value('bias') == 'Gyro' and gyro.value('scale') is None and gyro.error == 'text of Gyro'
    gyro.last.level = DiagnosticStatus.WARN
    assert gyro.error == ''


@pytest.mark.parametrize('values, is_running, factor, lines', [
    ({'gyro_scale': 1.3}, True, 1.3, 0), ({'gyro_scale': 1.3}, False, 1.0, 1), (None, True, 1.0, 1),
    ({'other': 1.3}, True, 1.0, 0), ({'gyro_scale': 0.1}, True, 0.1, 0), ({'gyro_scale': 10}, True, 10, 0)])
def test_a_factor_is_1_unless_a_running_base_has_it(monkeypatch, values, is_running, factor, lines):
    logged = []
    monkeypatch.setattr(rospy, 'get_param', lambda name, _: {'/base': values}.get(name))
    monkeypatch.setattr(rospy, 'logwarn', lambda *line: logged.append(line))
    monkeypatch.setattr(module, 'call', lambda _, method, name: 'http://base' if is_running else '')
    assert module.factor_set('base', 'gyro_scale') == factor and len(logged) == lines


@pytest.mark.parametrize('factor', [0.099, 10.1, 'x'])
def test_a_factor_that_is_not_valid(monkeypatch, factor):
    monkeypatch.setattr(rospy, 'get_param', lambda *_: {'gyro_scale': factor})
    monkeypatch.setattr(module, 'call', lambda *_: 'http://base')
    with pytest.raises(rospy.ROSException, match='/base/gyro_scale: .*expected the correction factor from 0.1 to 10'):
        module.factor_set('base', 'gyro_scale')


@pytest.mark.parametrize('name', ['', 'a b', 7])
def test_a_base_needs_a_name(name):
    assert module.check_node_name('/r1/base') == '/r1/base'
    with pytest.raises(ConfigError, match='base_node: .*: expected the name of a node'):
        module.check_node_name(name)
