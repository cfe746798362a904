"""The usage text of a node lists everything that the node offers."""
import ast
import os

from rbx1_nav.extras.create.emulator.fault_services import CHANGEABLE, SWITCHES

ROOT = os.path.join(os.path.dirname(__file__), '..', '..', '..')


def read(*path):
    with open(os.path.join(ROOT, *path), encoding='utf-8') as file:
        return file.read()


def test_the_faults_of_the_emulated_robot():
    offered = {'pull_cable', 'power_cycle', *SWITCHES, *CHANGEABLE}
    text = ast.get_docstring(ast.parse(read('nodes', 'fake_create.py')))
    assert len(offered) == 17
    for name in offered:
        assert f'~{name}' in text
