"""The motion errors that vary along the path have the right variance and tails, and depend only on path and seed."""
import random
from statistics import mean

import pytest
from hypothesis import given
from hypothesis import strategies as st

from rbx1_nav.simulation.floor_noise import Noise, Roughness
from sample_surface import SURFACE

ROUGH = SURFACE._replace(heading_noise_turning=0.1, heading_noise_straight=0.08, distance_noise=0.03)
seeds = st.integers(0, 2 ** 31 - 1)
steps = st.floats(0, 2)


def total(noise, parts):
    """Return the error after a path in parts."""
    return sum(map(noise.over, parts))


@given(seeds, st.floats(0, 1), st.floats(0.01, 1), st.lists(steps, max_size=30), st.lists(st.floats(0, 1), max_size=30))
def test_the_error_does_not_depend_on_how_the_path_is_cut(seed, strength, cell, first, fractions):
    path = sum(first)
    cuts = [0.0, *sorted(path * fraction for fraction in fractions), path]
    others = [end - start for start, end in zip(cuts, cuts[1:])]
    some, other = (Noise(strength, cell, random.Random(seed)) for _ in range(2))
    # a path of 60 has up to 6000 cells, each with the rounding of a sum
    assert total(some, first) == pytest.approx(total(other, others), abs=1e-9)


@given(seeds, st.lists(st.tuples(st.floats(-1, 1), st.floats(-3, 3), st.floats(0, 1)), max_size=20))
def test_the_errors_of_a_run_do_not_depend_on_its_steps(seed, motions):
    whole, parts = Roughness(ROUGH, seed), Roughness(ROUGH, seed)
    for straight, turn, fraction in motions:
        cut = [parts.over(straight * part, turn * part) for part in (fraction, 1 - fraction)]
        assert [sum(errors) for errors in zip(*cut)] == pytest.approx(whole.over(straight, turn), abs=1e-9)


@pytest.mark.parametrize('step', [0.02, 0.3, 6.0])
def test_the_variance_grows_by_the_square_of_the_strength_with_each_unit(step):
    strength, cell, count, halves = 0.2, 0.25, 2000, []
    for seed in range(count):
        noise = Noise(strength, cell, random.Random(seed))
        halves.append([total(noise, [step] * round(6 / step)) for _ in range(2)])
    wholes = [sum(errors) for errors in halves]
    for path, errors in (6, [first for first, _ in halves]), (6, [second for _, second in halves]), (12, wholes):
        # the first and the last cell are not complete: this costs a third of a cell, whatever the length of the path
        expected = strength ** 2 * (path - cell / 3)
        # 1 sigma of the variance is sqrt(2 / count) of its value, or 3.2 %; of the mean sqrt(1 / count): five of each
        assert mean(error ** 2 for error in errors) == pytest.approx(expected, rel=0.16)
        assert abs(mean(errors)) < 5 * (expected / count) ** 0.5


def test_large_errors_are_more_frequent_than_in_a_normal_distribution():
    noise = Noise(1.0, 0.25, random.Random(0))
    noise.over(noise.left)      # to the next cell
    errors = [noise.over(0.25) for _ in range(20000)]
    variance = mean(error ** 2 for error in errors)
    # 1 for the sum of four cells; the kurtosis of a Laplace distribution is 6, of a normal one 3
    assert variance == pytest.approx(0.25, rel=0.08)
    assert 5 < mean(error ** 4 for error in errors) / variance ** 2 < 7


@pytest.mark.parametrize('key, straight, turn, index', [
    ('heading_noise_turning', 0.0, 1.0, 1), ('heading_noise_straight', 1.0, 0.0, 1), ('distance_noise', 1.0, 0.0, 0)])
def test_each_key_acts_on_its_own_error_by_its_own_motion(key, straight, turn, index):
    roughness = Roughness(SURFACE._replace(**{key: 0.05}), 3)
    assert roughness.over(turn, straight) == (0.0, 0.0)     # the other motion
    errors = roughness.over(-straight, -turn)               # backward like forward
    assert errors[index] != 0.0 and errors[1 - index] == 0.0


def test_the_errors_depend_on_the_seed_only():
    first, same, other = (Roughness(ROUGH, seed).over(5.0, 5.0) for seed in (7, 7, 8))
    assert first == same and not set(first) & set(other)


def test_the_errors_of_distance_and_heading_have_nothing_in_common():
    errors = [Roughness(ROUGH._replace(heading_noise_turning=0.0), seed).over(1.0, 0.0) for seed in range(2000)]
    distance, angle = zip(*errors)
    correlation = mean(a * b for a, b in errors) / (mean(a * a for a in distance) * mean(b * b for b in angle)) ** 0.5
    assert abs(correlation) < 0.11      # five times 1 sigma, 1 / sqrt(2000)
