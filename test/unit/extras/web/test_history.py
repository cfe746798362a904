"""Paths, speeds and log lines, thinned out and bounded."""
from rbx1_nav.extras.web.history import PATH_POINTS, Counter, Path, Speeds


def test_a_path_has_points_at_a_distance():
    path = Path(Counter())
    for step in range(101):
        path.move(0.001 * step, 0.0, 0.0)
    # a point for each 2 cm, the first one among them
    assert [point[0] for point in path.since(0)] == [0.0, 0.02, 0.04, 0.06, 0.08, 0.1]


def test_a_path_is_bounded():
    path = Path(Counter())
    for step in range(2 * PATH_POINTS):
        path.move(0.1 * step, 0.0, 0.0)
    assert len(path.since(0)) == PATH_POINTS


def test_a_steady_speed_is_thinned_out_and_its_end_kept():
    speeds = Speeds(Counter())
    for tick in range(26):
        speeds.sample(0.1 * tick, 0.2, 0.0)
    speeds.sample(2.6, 0.1, 0.0)
    # a sample a second; and the last one before the change, for the line between the two to be right
    assert speeds.since(0) == [[0.0, 0.2, 0.0], [1.0, 0.2, 0.0], [2.0, 0.2, 0.0], [2.5, 0.2, 0.0], [2.6, 0.1, 0.0]]
