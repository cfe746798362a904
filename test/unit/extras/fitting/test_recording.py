"""Invalid recordings are rejected with a one-line message."""
from math import inf, nan

from hypothesis import given, strategies as st
import numpy
import pytest

from rbx1_nav.base.kinematics import ORIGIN
from rbx1_nav.base.robot_parameters import read_robot
from rbx1_nav.extras.fitting.recording import Commands, Track, check_end, check_recording, in_force, relative
from rbx1_nav.node.config import ConfigError
from sample_runs import EXERCISE, record

RUN = record(EXERCISE[:2])
SERIES = st.sampled_from(['commands', 'odometry', 'gyro', 'truth'])


def changed(name, field, index, value):
    """Return the run with one value changed, and the name of the field."""
    series = getattr(RUN, name)
    field = series._fields[field % len(series)]
    values = getattr(series, field).copy()
    values[index % len(values)] = value
    return RUN._replace(**{name: series._replace(**{field: values})}), field, index % len(values)


@given(SERIES, st.integers(0, 3), st.integers(0, 10000), st.sampled_from([nan, inf, -inf, 1e300]))
def test_every_number_is_finite(name, field, index, value):
    run, field, index = changed(name, field, index, value)
    with pytest.raises(ConfigError) as error:
        check_recording(run)
    assert str(error.value) == 'run: %s: %s of message %d: %s: expected a finite number below 1e10' % (
        name, field, index + 1, value)


@given(SERIES, st.integers(1, 10000), st.floats(0.021, 100))
def test_stamps_never_go_back(name, index, by):
    time = getattr(RUN, name).time
    index = 1 + index % (len(time) - 1)
    run, _, _ = changed(name, 0, index, time[index - 1] - by)
    with pytest.raises(ConfigError, match='run: %s: stamp of message %d: .* s before message %d'
                       % (name, index + 1, index)):
        check_recording(run)


@pytest.mark.parametrize('name', ['odometry', 'truth'])
def test_no_motion(name):
    time = getattr(RUN, name).time
    with pytest.raises(ConfigError, match=f'^run: {name}: the robot did not move, although'):
        check_recording(RUN._replace(**{name: Track(time, 0 * time, 0 * time, 0 * time)}))
    zero = 0 * RUN.commands.linear
    with pytest.raises(ConfigError, match='^run: no motion: expected commands other than 0'):
        check_recording(RUN._replace(commands=Commands(RUN.commands.time, zero, zero)))


@pytest.mark.parametrize('name', ['odometry', 'gyro', 'truth'])
def test_all_stamps_are_of_one_clock(name):
    series = getattr(RUN, name)
    with pytest.raises(ConfigError, match=f'^run: {name} from 1000.0 to .*: expected the same time span, on one clock'):
        check_recording(RUN._replace(**{name: series._replace(time=series.time + 1000)}))


def test_a_measured_end_pose_needs_odometry_until_the_stop():
    last = RUN.odometry.time[-1]
    stop = Commands(*map(numpy.append, RUN.commands, (last, 0.0, 0.0)))
    check_end(RUN._replace(commands=stop, end=ORIGIN))
    for commands, end in (stop._replace(time=stop.time + 0.01), f'{last + 0.01:.1f}'), (RUN.commands, 'inf'):
        with pytest.raises(ConfigError, match=f'until {last:.1f} s, but the robot drives until {end} s: expected'):
            check_end(RUN._replace(commands=commands, end=ORIGIN))


def test_commands_in_force_are_limited_and_time_out():
    robot = read_robot({'controllers': {'base': {'type': 'diff_controller', 'base_width': 0.26, 'timeout': 0.5,
                                                 'max_linear_speed': 0.3, 'max_angular_speed': 1.0}}})
    commands = in_force(Commands(numpy.array([0.0, 0.4, 2.0]), numpy.array([0.5, 0.1, 0.2]),
                                 numpy.array([0.0, -2.0, 0.5])), robot)
    assert commands.time.tolist() == pytest.approx([0.0, 0.4, 0.9, 2.0, 2.5])
    assert commands.linear.tolist() == [0.3, 0.1, 0.0, 0.2, 0.0]
    assert commands.angular.tolist() == [0.0, -1.0, 0.0, 0.5, 0.0]


@given(*3 * [st.tuples(*3 * [st.floats(-3, 3)])])
def test_relative_poses_do_not_depend_on_where_the_origin_is(pose, other, shift):
    def moved(one):
        c, s = numpy.cos(shift[2]), numpy.sin(shift[2])
        return shift[0] + c * one[0] - s * one[1], shift[1] + s * one[0] + c * one[1], one[2] + shift[2]
    assert relative(moved(pose), moved(other)) == pytest.approx(relative(pose, other), abs=1e-9)
