"""Bags are read into Recordings, and a bag that is not a run of one robot causes an error of one line."""
from math import nan

import numpy
import pytest
import rosbag
from std_msgs.msg import String

from rbx1_nav.extras.fitting.bags import TopicNames, read_bag
from rbx1_nav.node.config import ConfigError
import sample_bags
from sample_bags import odometry, pose_stamped, run_messages, write_bag

TOPICS = TopicNames('/cmd_vel', '/odom', '/imu/data', '/ground_truth')


@pytest.fixture(name='path')
def path_of_bag(tmp_path):
    return str(tmp_path / 'run.bag')


def test_a_run(path):
    write_bag(path, run_messages())
    recording = read_bag(path, TOPICS)
    count = sum(ticks for _, _, ticks in sample_bags.MOTIONS)
    for series in recording.commands, recording.odometry, recording.gyro, recording.truth:
        assert len(series.time) == count
        # bags and headers have a resolution of 1 ns, but floats of this size resolve only 14 ns
        assert numpy.allclose(series.time, 100 + numpy.arange(count) / sample_bags.RATE, rtol=0, atol=1e-6)
    assert set(recording.commands.linear) == {0.0, 0.2}
    assert set(recording.gyro.rate) == {0.0, 0.5, 1.0}
    # not wrapped: 3.15 rad on the spot, then 0.5 rad in the arc
    assert recording.truth.yaw[-1] == pytest.approx(3.65, abs=1e-6)
    assert recording.end is None


def test_the_truth_may_be_poses(path):
    messages = [(topic, pose_stamped(time, 1.0 + time, 0.0, 0.0) if topic == '/ground_truth' else message, time)
                for topic, message, time in run_messages()]
    write_bag(path, messages)
    assert read_bag(path, TOPICS).truth.x[0] == pytest.approx(101.0)


def test_odometry_and_gyro_may_be_missing(path):
    write_bag(path, [each for each in run_messages() if each[0] in ('/cmd_vel', '/ground_truth')])
    recording = read_bag(path, TOPICS)
    assert recording.odometry is None and recording.gyro is None
    assert read_bag(path, TOPICS._replace(truth=None)).truth is None


def with_changed(topic, number, change):
    """Return the messages of a run with one changed message: message `number` of a topic."""
    count = -1
    for each in run_messages():
        count += each[0] == topic
        yield change(*each) if each[0] == topic and count == number else each


def without(*topics):
    """Return the messages of a run without some topics."""
    return [each for each in run_messages() if each[0] not in topics]


def shifted(topic, seconds):
    """Return the messages of a run with later header stamps on a topic."""
    return [(name, odometry(time + seconds, message.pose.pose.position.x, 0.0, 0.0) if name == topic else message, time)
            for name, message, time in run_messages()]


@pytest.mark.parametrize('messages, text', [
    ([], '/cmd_vel: no messages of type geometry_msgs/Twist: expected some; the bag has none at all'),
    (without('/cmd_vel'), '/cmd_vel: no messages of type geometry_msgs/Twist'),
    (without('/ground_truth'),
     '/ground_truth: no messages of type nav_msgs/Odometry or geometry_msgs/PoseStamped'),
    (run_messages([(0.0, 0.0, 200)]), 'no motion: expected commands other than 0'),
    ([(topic, odometry(time, 0.0, 0.0, 0.0) if topic == '/odom' else message, time)
      for topic, message, time in run_messages()],
     'odometry: the robot did not move, although it was commanded to'),
    (with_changed('/odom', 30, lambda topic, _, time: (topic, odometry(time, nan, 0.0, 0.0), time)),
     'odometry: x of message 31: nan: expected a finite number'),
    (with_changed('/odom', 30, lambda topic, _, time: (topic, odometry(time - 1, 0.0, 0.0, 0.0), time)),
     'odometry: stamp of message 31: 0.950 s before message 30: expected stamps that never decrease'),
    ([(topic, odometry(time, 3.0, 0.0, 0.0) if topic == '/odom' and round(time * 50) % 2 else message, time)
      for topic, message, time in run_messages()], '/odom: jumps by '),
    (shifted('/odom', 1e6), 'odometry from 1000100.0 to '),
    ([(topic, String('x') if topic == '/odom' else message, time) for topic, message, time in run_messages()],
     '/odom: std_msgs/String: expected nav_msgs/Odometry'),
    ([(topic, String('x') if topic == '/cmd_vel' else message, time) for topic, message, time in run_messages()],
     '/cmd_vel: std_msgs/String: expected geometry_msgs/Twist'),
], ids=lambda value: value if isinstance(value, str) else '')
def test_one_line_for_a_bag_that_is_no_run(path, messages, text):
    write_bag(path, messages)
    with pytest.raises(ConfigError) as error:
        read_bag(path, TOPICS)
    assert text in str(error.value) and str(error.value).startswith(f'{path}: ')
    assert '\n' not in str(error.value)


@pytest.mark.parametrize('content', [b'', b'not a bag', b'#ROSBAG V2.0\n', b'#ROSBAG V2.0\n' + bytes(range(256)) * 20,
                                     b'#ROSBAG V9.9\n', b'#ROSBAG V1.2\n' + b'\xff' * 99])
def test_one_line_for_what_is_no_bag(path, content):
    with open(path, 'wb') as file:
        file.write(content)
    with pytest.raises(ConfigError, match='expected a bag: .'):
        read_bag(path, TOPICS)


@pytest.mark.parametrize('name', ['nothing.bag', '.'])
def test_one_line_for_a_file_that_cannot_be_read(tmp_path, name):
    with pytest.raises(ConfigError, match='expected a bag: .'):
        read_bag(str(tmp_path / name), TOPICS)


def test_definitions_in_a_bag_are_never_executed(path, monkeypatch):
    write_bag(path, run_messages() + [('/other', String('x'), 101.0)])

    def refuse(*_):
        raise AssertionError('a class was generated from the bag')
    monkeypatch.setattr(rosbag.bag.genpy.dynamic, 'generate_dynamic', refuse)
    read_bag(path, TOPICS)
