"""The udev rules for the serial adapter: udev ignores a line that it cannot parse, and only logs it."""
import os
import re

import pytest

PATH = os.path.join(os.path.dirname(__file__), '..', '..', 'config', 'create', '60-turtlebot-create.rules')
# udev(7): match keys, and assignment keys
COMPARED = {'ACTION', 'SUBSYSTEM', 'DRIVER', 'ATTRS{idVendor}', 'ATTRS{idProduct}', 'ENV{CREATE_CABLE}'}
ASSIGNED = {'ENV{CREATE_CABLE}', 'ENV{ID_MM_PORT_IGNORE}', 'ENV{ID_MM_DEVICE_IGNORE}', 'SYMLINK', 'GROUP', 'MODE',
            'ATTR{latency_timer}', 'GOTO', 'LABEL'}

with open(PATH, encoding='ascii') as file:
    RULES = [line.rstrip('\n') for line in file if line.strip() and not line.startswith('#')]


def parts(rule):
    """(key, operator, value) of each part of a rule."""
    return [re.fullmatch(r'([A-Z]+(?:\{\w+\})?)(==|!=|\+=|:=|=)"([^"]*)"', part).groups() for part in rule.split(', ')]


@pytest.mark.parametrize('rule', RULES)
def test_a_rule_is_well_formed(rule):
    for key, operator, _ in parts(rule):
        assert key in (COMPARED if operator in ('==', '!=') else ASSIGNED)
    operators = [operator in ('==', '!=') for _, operator, _ in parts(rule)]
    assert operators == sorted(operators, reverse=True), 'what is compared comes first'


def test_a_jump_has_its_label_below():
    found = [(index, key, value) for index, rule in enumerate(RULES) for key, _, value in parts(rule)
             if key in ('GOTO', 'LABEL')]
    assert [key for _, key, _ in found] == ['GOTO', 'LABEL'] and len({value for _, _, value in found}) == 1


def test_the_adapters_are_four_hexadecimal_digits():
    numbers = [value for rule in RULES for key, _, value in parts(rule) if key.startswith('ATTRS')]
    assert len(numbers) >= 10 and all(re.fullmatch('[0-9a-f]{4}', number) for number in numbers)
