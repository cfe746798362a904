"""`random` draws a seed, as a launch file's default: one that repeats the run if it is given instead."""
from rbx1_nav.model.surfaces import read_seed


def test_random_draws_a_seed_each_time():
    seeds = {read_seed('random') for _ in range(20)}
    # twenty equal ones out of a million would be a wonder
    assert len(seeds) > 1
    assert all(read_seed(seed) == read_seed(str(seed)) == seed for seed in seeds)
