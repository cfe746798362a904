"""Each method that is declared has its script."""
import os

from rbx1_nav.exercise.methods import METHODS

NODES = os.path.join(os.path.dirname(__file__), '..', '..', '..', 'nodes')


def test_each_method_has_a_script():
    for each in METHODS.values():
        assert os.path.exists(os.path.join(NODES, each.script)) and each.pose in ('', 'odometry', 'estimate')


def test_the_fleet_finds_the_script_of_a_method_by_its_name():
    for each in METHODS.values():
        assert each.filtered or each.script == f'{each.name}_out_and_back.py'
