"""A configuration that does not belong to the robot's URDF is named, with what to do; one that does is not."""
import os
import random

import pytest

from rbx1_nav.base.model_check import Published, find_prefix_problem, find_problems
from rbx1_nav.base.robot_parameters import load_robot, read_robot
from rbx1_nav.base.urdf import read_tree

ROOT = os.path.join(os.path.dirname(__file__), '..', '..', '..')
NOTHING = Published({}, set())
KEYS = '/arbotix/controllers/base/base_frame_id', '/arbotix/controllers/base'


def joint(name, kind, child, parent='base_link'):
    return (f'<link name="{child}"/><joint name="{name}" type="{kind}"><parent link="{parent}"/>'
            f'<child link="{child}"/></joint>')


def urdf(*joints, root='base_link'):
    return f'<robot name="test"><link name="{root}"/>{"".join(joints)}</robot>'


WHEELS = [joint('left_joint', 'continuous', 'left'), joint('right_joint', 'continuous', 'right')]
CASTER = joint('caster_joint', 'continuous', 'caster')
NAMES = dict(left_wheel='left_joint', right_wheel='right_joint')


def robot(joints=(), **keys):
    return read_robot({'controllers': {'base': dict({'type': 'diff_controller', 'base_width': 0.3}, **keys)},
                       'joints': {name: {} for name in joints}})


def problems(text, published=NOTHING, prefix='', reads_base=True, joints=(), **keys):
    return find_problems(robot(joints, **keys), prefix, KEYS, read_tree(text), published, reads_base)


@pytest.mark.parametrize('name', ['turtlebot', 'pi_robot'])
def test_the_robots_of_this_package_have_no_problem(name):
    with open(os.path.join(ROOT, 'urdf', f'{name}.urdf')) as file:
        tree = read_tree(file.read())
    assert not find_problems(load_robot(os.path.join(ROOT, 'config', f'{name}.yaml')), '', KEYS, tree, NOTHING, True)


@pytest.mark.parametrize('text, options', [
    (urdf(*WHEELS), NAMES),
    # fixed wheels, and a joint that mimics another one, need no joint states
    (urdf(joint('wheel', 'fixed', 'wheel')), {}),
    (urdf(*WHEELS, joint('finger', 'prismatic', 'finger').replace('</joint>', '<mimic joint="left_joint"/></joint>')),
     NAMES),
    # the servos of the YAML file
    (urdf(*WHEELS, joint('head', 'revolute', 'head')), dict(NAMES, joints=['head'])),
    # published by others: as joint states, or as a transform
    (urdf(*WHEELS, CASTER), dict(NAMES, published=Published({'/publisher': {'caster_joint'}}, set()))),
    (urdf(*WHEELS, CASTER), dict(NAMES, published=Published({}, {'caster'}))),
    (urdf(*WHEELS, CASTER), dict(NAMES, published=Published({}, {'r1/caster'}), prefix='r1')),
    (urdf(*WHEELS), dict(NAMES, published=Published({'/publisher': {'left_joint', 'right_joint'}}, set()),
                         reads_base=False)),
    # the transform from the base frame to the root comes from another node
    (urdf(*WHEELS), dict(NAMES, base_frame_id='base_footprint', published=Published({}, {'base_link'}))),
    # prefixes that robot_state_publisher adds, or that are in the links
    (urdf(*WHEELS), dict(NAMES, base_frame_id='r1/base_link', prefix='r1')),
    (urdf(*WHEELS).replace('base_link', 'r1/base_link'), dict(NAMES, base_frame_id='r1/base_link', prefix='r1'))])
def test_what_belongs_together_is_not_named(text, options):
    assert problems(text, **options) == []


@pytest.mark.parametrize('text, options, parts', [
    (urdf(*WHEELS), dict(NAMES, base_frame_id='base_footprint'),
     ['base/base_frame_id: base_footprint: not a link', 'expected its root, base_link']),
    (urdf(*WHEELS), dict(NAMES, base_frame_id='left'), ['left has two parents', 'expected its root, base_link']),
    (urdf(*WHEELS), {}, ['nobody publishes left_joint, right_joint,', 'no transform to left, right:',
                         'expected the wheels as left_wheel and right_wheel of /arbotix/controllers/base '
                         '(now base_l_wheel_joint and base_r_wheel_joint)']),
    (urdf(*WHEELS, CASTER), {}, ['left_joint, right_joint, caster_joint,', 'as left_wheel',
                                 'and joint_state_publisher for the other joints']),
    (urdf(*WHEELS, CASTER), NAMES, ['nobody publishes caster_joint,', 'no transform to caster: '
                                    'expected joint_state_publisher, see docs/your_robot.md']),
    (urdf(*WHEELS, joint('lift', 'prismatic', 'lift')), NAMES, ['nobody publishes lift,']),
    # one wheel has another name
    (urdf(*WHEELS), dict(NAMES, left_wheel='left'), ['nobody publishes left_joint,', '(now left and right_joint)']),
    # joint_state_publisher beside the base
    (urdf(*WHEELS), dict(NAMES, published=Published({'/publisher': {'left_joint', 'right_joint'}}, set())),
     ['/publisher and the base publish left_joint, right_joint', 'source_list']),
    # two of them, beside a base of another topic
    (urdf(*WHEELS), dict(NAMES, reads_base=False,
                         published=Published({'/a': {'left_joint', 'right_joint'}, '/b': {'left_joint'}}, set())),
     ['/a and /b publish left_joint, so that the angles alternate']),
    (urdf(*WHEELS), dict(published=Published({'/publisher': {'left_joint', 'right_joint'}}, set())),
     ['base_l_wheel_joint and base_r_wheel_joint is no movable joint of robot_description', 'or right_joint'])])
def test_what_does_not_belong_together_is_named_in_one_line_with_the_cure(text, options, parts):
    line, = problems(text, **options)
    assert '\n' not in line and all(part in line for part in parts)


@pytest.mark.parametrize('seed', range(20))
def test_one_change_of_a_good_robot_is_one_problem(seed):
    generator = random.Random(seed)
    joints, keys, root = [*WHEELS], dict(NAMES), 'base_link'
    change = generator.choice(['wheel', 'wheels', 'caster', 'frame', 'root', 'joint'])
    side = generator.choice(['left', 'right'])
    if change == 'wheel':
        keys[f'{side}_wheel'] = f'{side}{generator.randrange(9)}'
    elif change == 'wheels':
        keys = {}
    elif change == 'caster':
        joints += [joint(f'caster{index}', 'continuous', f'caster{index}', side)
                   for index in range(generator.randrange(1, 4))]
    elif change == 'frame':
        keys['base_frame_id'] = generator.choice(['base_footprint', side, 'odom2'])
    elif change == 'root':
        root = 'base_footprint'
        joints += [joint('base_joint', 'fixed', 'base_link', root)]
    else:
        joints[side == 'left'] = joints[side == 'left'].replace('_joint"', '_hinge"')
    assert len(problems(urdf(*joints, root=root), **keys)) == 1, change


def test_a_prefix_that_the_links_do_not_have_leads_to_the_argument_of_the_launch_file():
    tree, base = read_tree(urdf(*WHEELS)), robot(base_frame_id='r1/base_link', **NAMES)
    assert find_prefix_problem(base, 'r1', tree).startswith("tf_prefix: r1: ")
    assert 'robot:=r1' in find_prefix_problem(base, 'r1', tree)
    assert not find_prefix_problem(robot(**NAMES), '', tree)
    assert not find_prefix_problem(base, 'r1', read_tree(urdf(*WHEELS).replace('base_link', 'r1/base_link')))


@pytest.mark.parametrize('text, expected', [
    ('', 'not a URDF file'), ('<html/>', '<html>: expected <robot>'), ('<robot name="a"/>', 'no <link>'),
    ('<robot name="a"><link name="b"/><link name="c"/></robot>', r"\['b', 'c'\]: expected exactly one"),
    ('<robot name="a"><xacro:include filename="b"/></robot>', 'a xacro file, not a URDF file: expected one')])
def test_a_text_that_is_no_model_is_rejected(text, expected):
    with pytest.raises(ValueError, match=expected):
        read_tree(text)
