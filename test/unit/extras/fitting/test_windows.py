"""The parts of a recorded run with a known end pose."""
import numpy
import pytest

from rbx1_nav.extras.fitting.recording import Commands, Recording, Track
from rbx1_nav.extras.fitting.run import PreparedRun

WIDTH = 0.26
COMMANDS = Commands(numpy.array([0.0, 40.0]), numpy.array([0.2, 0.2]), numpy.array([0.1, 0.1]))


def make_run(gaps=(), rate=100.0):
    """Return a PreparedRun of 40 s on a circle of radius 2 m, without truth between the pairs of `gaps` (s)."""
    times = numpy.arange(round(40 * rate) + 1) / rate
    for start, end in gaps:
        times = times[(times <= start) | (times >= end)]
    yaw = 1.0 + 0.1 * times
    truth = Track(times, 2 * numpy.sin(yaw), -2 * numpy.cos(yaw), yaw)
    return PreparedRun(Recording('circle', COMMANDS, None, None, truth, None), WIDTH)


def starts(run, windows):
    return run.times[windows.first].tolist()


def test_windows_follow_each_other_or_begin_a_stride_apart():
    run = make_run()
    assert starts(run, run.windows(10)) == pytest.approx([0, 10, 20, 30])
    assert starts(run, run.windows(10, 5)) == pytest.approx([0, 5, 10, 15, 20, 25, 30])
    assert run.windows(10).length == 200


def test_the_end_of_a_window_is_in_the_frame_of_its_start():
    windows = make_run().windows(10)
    # an arc with a radius of 2 m to the left
    assert windows.ends == pytest.approx(numpy.array([[2 * numpy.sin(1), 2 - 2 * numpy.cos(1), 1.0]] * 4), abs=1e-4)


@pytest.mark.parametrize('gap', [(12.0, 12.3), (5.0, 15.0), (9.9, 10.3), (19.8, 20.1), (12.001, 12.3)])
def test_a_window_with_a_gap_of_the_truth_is_left_out(gap):
    run = make_run([gap])
    for length, stride in (10, 10), (10, 1), (2, 0.5), (0.5, 0.05):
        expected = [start for start in starts(run, make_run().windows(length, stride))
                    if start + length < gap[0] + 1e-6 or start > gap[1] - 1e-6]
        found = starts(run, run.windows(length, stride))
        # no window has a gap, and every window without a gap is kept, except those that touch it
        assert set(found) <= set(expected)
        assert len(found) >= len(expected) - 2
        assert found


def test_the_window_of_a_whole_run_ends_after_the_predicted_number_of_turns():
    recording = Recording('taped', COMMANDS, None, None, None, (1.0, 0.5, 0.1))
    run = PreparedRun(recording, WIDTH)
    windows = run.whole(4 * numpy.pi - 0.2)
    assert windows.ends == pytest.approx(numpy.array([[1.0, 0.5, 4 * numpy.pi + 0.1]]))
    assert (windows.first, windows.length) == (0, len(run.times) - 1)
