"""Many runs whose wheels are computed once have the results of single runs, to the last bit."""
import os
import random

import pytest

from rbx1_nav.base.robot_parameters import load_robot
from rbx1_nav.base.surfaces import load_surface
from rbx1_nav.exercise.legs import StuckError
from rbx1_nav.extras.many_runs.cases import Case, simulate_row, simulate_rows
from rbx1_nav.extras.many_runs.simulated_run import PARAMETERS
from rbx1_nav.simulation.floor import make_floor
from rbx1_nav.simulation.many_floors import ManyFloors
from sample_surface import SURFACE

CONFIG = os.path.join(os.path.dirname(__file__), '..', '..', '..', '..', 'config')
TURTLEBOT = load_robot(os.path.join(CONFIG, 'turtlebot.yaml'))
SEEDS = range(20, 28)


@pytest.mark.parametrize('method, surface', [('timed', 'hard_floor'), ('timed', 'low_ply_carpet'),
                                             ('timed', 'create_lab_floor'), ('odom', 'low_ply_carpet'),
                                             ('timed', 'ideal')])
def test_rows(method, surface):
    case = Case(method, TURTLEBOT, load_surface(surface, os.path.join(CONFIG, 'surfaces')), PARAMETERS)
    # repr() distinguishes all numbers, their types and -0.0
    assert repr(simulate_rows((case, SEEDS))) == repr([simulate_row(case, seed) for seed in SEEDS])


def test_any_path_on_a_floor_with_all_errors():
    surface = SURFACE._replace(curvature=-0.1, turning_loss=0.04, heading_noise_turning=0.09,
                               heading_noise_straight=0.07, distance_noise=0.04)
    together, single = ManyFloors(surface, SEEDS), [make_floor(surface, seed) for seed in SEEDS]
    chosen = random.Random(0)
    for _ in range(300):
        path = chosen.choice([(0.004, 0.0), (0.0, -0.02), (-0.4, 0.7), (0.003, 1e-4), (0.02, -0.01), (0.0, 3.0)])
        for floor in (together, *single):
            floor.move(*path)
        assert [list(values) for values in together.truth.pose] == list(map(list, zip(*(
            floor.truth.pose for floor in single))))
        assert list(zip(*together.slipped(*path))) == [floor.slipped(*path) for floor in single]


def test_all_runs_get_stuck_together_and_the_first_one_is_named():
    case = Case('odom', TURTLEBOT, SURFACE._replace(drag_turning=0.04), PARAMETERS)
    texts = []
    for run in lambda: simulate_rows((case, SEEDS)), lambda: simulate_row(case, SEEDS[0]):
        with pytest.raises(StuckError, match='^odom, seed 20: turn left: no progress for 5 s') as error:
            run()
        texts.append(str(error.value))
    assert texts[0] == texts[1]
