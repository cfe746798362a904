"""The covariance that is stored as a square root is the same as the covariance of the textbook."""
import numpy
import pytest

from rbx1_nav.estimation.covariance import Covariance

SIZE = 5
DEVIATIONS = [0.5, 1.0, 2.0, 0.1, 0.2]


class Walk:
    """Process noise of the last element that accumulates until it is used."""

    def __init__(self):
        self.variance = 0.0

    def __call__(self):
        columns = numpy.zeros((SIZE, 2))
        columns[-1, 0] = self.variance ** 0.5
        self.variance = 0.0
        return columns


def make():
    """Return a Covariance with DEVIATIONS, its process noise, and the dense matrix."""
    walk = Walk()
    return Covariance(DEVIATIONS, walk), walk, numpy.diag(numpy.square(DEVIATIONS))


def check(covariance, walk, expected):
    """Check a Covariance against a dense matrix, which contains the process noise."""
    expected = expected.copy()
    expected[-1, -1] -= walk.variance       # not added yet
    # rounding errors of some hundred operations with numbers of about 1
    numpy.testing.assert_allclose(covariance.of_first(SIZE), expected, atol=1e-11)
    assert [covariance.variance(index) for index in range(SIZE)] == pytest.approx(numpy.diag(expected), abs=1e-11)
    numpy.testing.assert_array_equal(covariance.of_first(2), covariance.of_first(SIZE)[:2, :2])


def test_it_starts_with_the_deviations():
    check(*make())


def test_steps_measurements_and_noise_are_those_of_the_textbook():
    covariance, walk, P = make()
    generator = numpy.random.default_rng(3)
    for number in range(150):       # far more columns than there is space for
        F = numpy.eye(SIZE)
        F[:3] += 0.1 * generator.normal(size=(3, SIZE))
        noise = 0.1 * generator.normal(size=(number % 3, 3))
        covariance.predict(F[:3], noise)
        P = F @ P @ F.T
        for column in noise:
            P[:3, :3] += numpy.outer(column, column)
        if number % 3 == 0:
            H, R, kept = generator.normal(size=SIZE), 0.3, [[1, 4], None][number % 2]
            K = P @ H / (H @ P @ H + R)
            if kept:
                K[kept] = 0.0
            numpy.testing.assert_allclose(covariance.update(H @ covariance.root, R, kept), K, atol=1e-10)
            left = numpy.eye(SIZE) - numpy.outer(K, H)
            P = left @ P @ left.T + R * numpy.outer(K, K)
        elif number % 3 == 1:
            column = 0.1 * generator.normal(size=SIZE)
            covariance.add(column)
            P += numpy.outer(column, column)
        else:
            covariance.add_to(2, 0.05)
            P[2, 2] += 0.05 ** 2
        check(covariance, walk, P)


@pytest.mark.parametrize('noises', [0, 1, 2])
def test_process_noise_is_added_now_and_then_and_only_once(noises):
    covariance, walk, P = make()
    added = 0
    for _ in range(100):
        walk.variance += 1e-4
        P[-1, -1] += 1e-4
        covariance.predict(numpy.eye(SIZE)[:3], [[0.1, 0.0]] * noises)
        P[0, 0] += noises * 0.1 ** 2
        check(covariance, walk, P)
        added += walk.variance == 0
    # there is space for some 30 columns of noise
    assert (noises * 100 // 40 <= added <= noises * 100 // 20) and bool(added) == bool(noises)


def test_a_measurement_reduces_the_variance_like_two_independent_measurements():
    covariance, _, _ = make()
    gain = covariance.update(covariance.root[1].copy(), 4.0)
    # information is the inverse of a variance: 1 / 1 and 1 / 4 add up
    assert covariance.variance(1) == pytest.approx(1 / (1 + 1 / 4)) and gain[1] == pytest.approx(1 / 5)
    assert covariance.variance(0) == pytest.approx(0.25) and gain[0] == 0


def test_kept_elements_stay_as_uncertain_as_they_are():
    covariance, _, _ = make()
    covariance.add(numpy.ones(SIZE))
    before = covariance.of_first(SIZE)
    gain = covariance.update(covariance.root[1].copy(), 0.01, [0, 2])
    after = covariance.of_first(SIZE)
    assert gain[0] == gain[2] == 0 and abs(gain[3]) > 0.1
    numpy.testing.assert_allclose(after[numpy.ix_([0, 2], [0, 2])], before[numpy.ix_([0, 2], [0, 2])])
    assert after[1, 1] < 0.1 * before[1, 1]


def test_doubt_and_drift_follow_the_steps_but_are_not_part_of_the_covariance():
    covariance, walk, P = make()
    covariance.doubt[:] = [0.0, 0.0, 1.0, 0.0, 0.0]
    covariance.drift[:] = [0.0, 0.0, 0.0, 1.0, 0.0]
    F = numpy.eye(SIZE)
    F[0, 2], F[1, 3] = 0.5, 0.25
    for _ in range(40):
        covariance.predict(F[:3], [[0.1, 0.0], [0.0, 0.2]])
        P = F @ P @ F.T + numpy.diag([0.01, 0.04, 0.0, 0.0, 0.0])
    check(covariance, walk, P)
    assert covariance.doubt == pytest.approx([20.0, 0.0, 1.0, 0.0, 0.0])
    assert covariance.drift == pytest.approx([0.0, 10.0, 0.0, 1.0, 0.0])


def test_a_new_pose_has_its_own_covariance_and_no_correlation():
    for columns in range(40):       # however many columns are in use
        covariance, walk, _ = make()
        for _ in range(columns):
            covariance.add(numpy.ones(SIZE))
        walk.variance = 0.5
        covariance.doubt[:] = covariance.drift[:] = 1.0
        before = covariance.of_first(SIZE)
        pose = numpy.array([[0.04, 0.01, 0.0], [0.01, 0.09, 0.02], [0.0, 0.02, 0.01]])
        covariance.replace_first(pose, 1e-9)
        covariance.add_to(0, 0.1)
        expected = numpy.zeros((SIZE, SIZE))
        expected[:3, :3], expected[3:, 3:] = pose, before[3:, 3:]
        expected[0, 0] += 0.1 ** 2
        expected[-1, -1] += 0.5
        numpy.testing.assert_allclose(covariance.of_first(SIZE), expected, atol=1e-11)
        assert list(covariance.doubt) == list(covariance.drift) == [0.0, 0.0, 0.0, 1.0, 1.0]


def test_a_new_pose_is_never_certain():
    covariance, _, _ = make()
    # a covariance with an eigenvalue of 0, and one below 0 by rounding
    covariance.replace_first(numpy.array([[1.0, 1.0], [1.0, 1.0]]) - 1e-17 * numpy.eye(2), 1e-6)
    assert numpy.linalg.eigvalsh(covariance.of_first(2)) == pytest.approx([1e-6, 2.0])
