"""Each method that is declared has its script, its button on the page and its launch argument."""
import os
import re

from rbx1_nav.exercise.methods import METHODS, OF_PAGE

ROOT = os.path.join(os.path.dirname(__file__), '..', '..', '..')


def read(*path):
    with open(os.path.join(ROOT, *path), encoding='utf-8') as file:
        return file.read()


def test_each_method_has_a_script_and_a_button_with_its_title():
    for each in METHODS.values():
        assert os.path.exists(os.path.join(ROOT, 'nodes', each.script)) and each.pose in ('', 'odometry', 'estimate')
    button = re.compile(r'class="run" data-method="(\w+)" data-pose="(\w*)" data-text="([^"]+)" disabled')
    buttons = button.findall(read('web', 'index.html'))
    assert buttons == [(name, each.pose, each.title) for name, each in OF_PAGE.items()]
    for each in OF_PAGE.values():
        assert f"'{each.title}': '{each.title.capitalize()}'" in read('web', 'words_en.js')


def test_the_fleet_starts_each_method_without_the_filter():
    started = set(re.findall(r"arg\('method'\) == '(\w+)'", read('launch', 'fleet_robot.launch')))
    assert started == {name for name, each in OF_PAGE.items() if each.pose != 'estimate'}
