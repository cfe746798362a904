"""The filter node passes each message to the filter, one at a time, and names what it rejects."""
import importlib.util
import os
from math import pi
from types import SimpleNamespace

from diagnostic_updater import DiagnosticStatusWrapper
from geometry_msgs.msg import PoseWithCovarianceStamped, Vector3
from nav_msgs.msg import Odometry
import pytest
import rospy
from sensor_msgs.msg import Imu

from rbx1_nav.filter import filter_status, one_sender
from rbx1_nav.filter.ekf_parameters import read_parameters
from fake_topics import replace_topics

NODE = os.path.join(os.path.dirname(__file__), '..', '..', '..', 'nodes', 'ekf.py')
HEADER = {'callerid': '/base'}


class Updater:
    """A diagnostic_updater.Updater."""

    def __init__(self):
        self.tasks = []

    def setHardwareID(self, _):
        pass

    def add(self, _, task):
        self.tasks.append(task)

    def force_update(self):
        for task in self.tasks:
            task(DiagnosticStatusWrapper())


@pytest.fixture(name='ekf')
def fixture_ekf(monkeypatch):
    """The node, with the messages of one base; ekf.lines: its log; ekf.now: ROS time."""
    spec = importlib.util.spec_from_file_location('ekf_node', NODE)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    monkeypatch.setattr(rospy.rostime, '_rostime_initialized', True)
    replace_topics(monkeypatch)
    lines = []
    for name in 'loginfo', 'logwarn', 'logerr':
        monkeypatch.setattr(rospy, name, lambda form, *values: lines.append(form % values))
    monkeypatch.setattr(filter_status, 'Updater', Updater)
    ekf = module.Ekf(read_parameters(dict(surface='unknown', publish_tf=False)))
    ekf.lines, ekf.module = lines, module

    def send(callback, message, now):
        monkeypatch.setattr(rospy.rostime, '_rostime_current', rospy.Time.from_sec(now))
        message._connection_header = HEADER
        if hasattr(message, 'header'):
            message.header.stamp = rospy.Time.from_sec(now)
        callback(message)
        return ekf.combined and ekf.combined.estimate
    ekf.send = send
    ekf.make = lambda **parameters: module.Ekf(read_parameters(dict(surface='unknown', publish_tf=False, **parameters)))
    return ekf


def odometry(x):
    message = Odometry(child_frame_id='base')
    message.header.frame_id, message.pose.pose.position.x, message.pose.pose.orientation.w = 'odom', x, 1.0
    return message


def imu(rate):
    return Imu(angular_velocity=Vector3(0.0, 0.0, rate), angular_velocity_covariance=[0.001, 0, 0] * 3,
               orientation_covariance=[-1.0] + [0.0] * 8)


def test_the_gyro_turns_the_path_of_the_odometry(ekf):
    for tick in range(101):
        ekf.send(ekf.on_imu, imu(0.5), 10 + tick * 0.02)
        estimate = ekf.send(ekf.on_odom, odometry(tick * 0.01), 10 + tick * 0.02)
    # 2 s at 0.5 rad/s and 0.5 m/s, which the bias before the first standstill and the wheels make uncertain
    assert 0.2 < estimate.pose.yaw < 1.1 and 0.3 < estimate.pose.y < 0.6
    # placed at the time of the last odometry
    message = PoseWithCovarianceStamped()
    message.pose.pose.position.x, message.pose.pose.orientation.w = 7.0, 1.0
    message.pose.covariance = [0.01 if index % 7 == 0 else 0.0 for index in range(36)]
    ekf.send(ekf.on_set_pose, message, 12.01)
    ekf.send(ekf.on_imu, imu(0.0), 12.02)
    assert ekf.send(ekf.on_odom, odometry(1.0), 12.02).pose.x == pytest.approx(7, abs=0.01)
    assert not [line for line in ekf.lines if 'rejected' in line]


def test_what_is_rejected_is_counted_and_named(ekf):
    ekf.send(ekf.on_set_pose, PoseWithCovarianceStamped(), 10.0)
    ekf.send(ekf.on_odom, odometry(0.0), 10.0)
    ekf.send(ekf.on_odom, odometry(float('nan')), 10.02)
    ekf.send(ekf.on_imu, imu(pi * 1e7), 10.02)
    assert ekf.diagnostics.rejected == {'odom': 1, 'imu_data': 1, 'set_pose': 1}
    rejected = [line.split(':')[0] for line in ekf.lines if line.endswith('; rejected')]
    assert rejected == ['/set_pose', '/odom', '/imu_data']


def test_messages_of_different_threads_reach_the_filter_one_at_a_time(ekf, monkeypatch):
    calls = []
    monkeypatch.setattr(ekf, 'process', lambda topic, *_: calls.append((topic, ekf.lock.locked())))
    for callback, message in (ekf.on_odom, odometry(0.0)), (ekf.on_imu, imu(0.0)), (
            ekf.on_set_pose, PoseWithCovarianceStamped()):
        ekf.send(callback, message, 10.0)
    monkeypatch.setattr(ekf.combined, 'reset', lambda _: calls.append(('reset', ekf.lock.locked())))
    ekf.on_reset(None)
    assert calls == [(each, True) for each in ('odom', 'imu_data', 'set_pose', 'reset')]
    monkeypatch.setattr(ekf.diagnostics, 'get_filter', lambda: calls.append(ekf.lock.locked()) or (None, 0))
    ekf.diagnostics.updater.force_update()
    assert calls[4:] == [True] * 3


@pytest.fixture(name='clock')
def fixture_clock(monkeypatch):
    """The monotonic clock; clock.publishers: what the master answers; clock.calls: number of calls to it."""
    clock = SimpleNamespace(now=100.0, publishers=[], calls=0)

    def call(_, method):
        assert method == 'getSystemState'
        clock.calls += 1
        if clock.publishers is None:
            raise ConnectionRefusedError
        return clock.publishers, [], []
    monkeypatch.setattr(one_sender, 'time', SimpleNamespace(monotonic=lambda: clock.now))
    monkeypatch.setattr(one_sender, 'call', call)
    return clock


def report(ekf, clock):
    """Update the diagnostics at 1 Hz for 20 s; return the lines, each with its time since the start."""
    found = []
    for second in range(20):
        ekf.lines.clear()
        ekf.diagnostics.update()
        found += [(second, line) for line in ekf.lines]
        clock.now += 1
    return found


def test_missing_messages_are_named_once(ekf, clock):
    lines, make = ekf.lines, ekf.make
    for parameters, expected in (
            ({}, ['Waiting for odometry: nobody publishes /odom',
                  'Waiting for IMU messages: /imu_data is published by /imu, /x, but no message has arrived']),
            (dict(imu_used=False), ['Waiting for odometry: nobody publishes /odom'])):
        clock.publishers = [['/imu_data', ['/imu', '/x']], ['/other', ['/x']]]
        ekf, clock.calls = make(**parameters), 0
        ekf.lines = lines
        assert report(ekf, clock) == [(5, line) for line in expected]
        assert clock.calls == len(expected)


def test_messages_that_arrive_are_not_missing(ekf, clock):
    lines, make, send = ekf.lines, ekf.make, ekf.send
    ekf = make()
    ekf.lines = lines
    send(ekf.on_imu, imu(0.0), 10.0)        # not used without odometry
    assert report(ekf, clock) == [(5, 'Waiting for odometry: nobody publishes /odom')]
    ekf = make()
    ekf.lines = lines
    send(ekf.on_imu, imu(0.0), 10.0)
    send(ekf.on_odom, odometry(float('nan')), 10.0)
    assert report(ekf, clock) == []


def test_without_a_master_it_asks_again(ekf, clock):
    lines, ekf = ekf.lines, ekf.make()
    ekf.lines, clock.publishers = lines, None
    assert report(ekf, clock) == []
    clock.publishers = []
    assert [line for _, line in report(ekf, clock)] == [
        'Waiting for odometry: nobody publishes /odom', 'Waiting for IMU messages: nobody publishes /imu_data']


def test_the_node_subscribes_publishes_and_reports_until_the_end(ekf, monkeypatch):
    topics, published, looks, listening, module = replace_topics(monkeypatch), [], [], [], ekf.module
    monkeypatch.setattr(ekf.tree, 'listen', listening.append)
    monkeypatch.setattr(ekf.publisher, 'update', lambda combined, *frames: published.append(frames))
    monkeypatch.setattr(module.life, 'init_node', lambda *_, **__: None)
    monkeypatch.setattr(module, 'load_parameters', lambda: ekf.parameters)
    monkeypatch.setattr(module, 'Ekf', lambda parameters: ekf)
    monkeypatch.setattr(module.life, 'end_requested', SimpleNamespace(is_set=lambda: len(looks) > 100))
    monkeypatch.setattr(module.life, 'sleep', looks.append)
    monkeypatch.setattr(module.time, 'monotonic_ns', lambda: 10 ** 12 + len(looks) * 50_000_000)
    monkeypatch.setattr(ekf.diagnostics.updater, 'force_update', lambda: published.append('diagnostics'))
    ekf.publisher.settled = False
    assert module.main() == 0
    # 5 s, once per second and at the beginning; it looks for frames until both inputs have theirs
    assert published == ['diagnostics'] * round(5 / ekf.parameters.diagnostic_period + 1) and listening == [True] * 102
    ekf.odom_sub = ekf.imu_sub = None       # topics here have no connections
    del looks[:]
    for tick in range(4):
        ekf.send(topics['imu_data'].callback, imu(0.0), 10 + tick / 50)
        ekf.send(topics['odom'].callback, odometry(0.0), 10 + tick / 50)
    assert published[-1] == ('odom', 'base') and ekf.diagnostics.received['odom'] == rospy.Time(10, 60_000_000)
    topics['reset_odometry'].callback(None)
    assert ekf.lines[-1] == 'Odometry was reset: restarting the filter at the odometry pose'
    ekf.send(topics['set_pose'].callback, PoseWithCovarianceStamped(), 10.1)
    assert ekf.diagnostics.rejected['set_pose'] == 1
    before, looks[:] = len(published), [0] * 101        # topics are closed during shutdown
    ekf.send(ekf.on_odom, odometry(0.0), 10.12)
    ekf.restart('/other')
    assert len(published) == before and ekf.lines[-1] == 'odom comes from another node: restarting'
