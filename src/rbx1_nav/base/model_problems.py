"""Compares a robot's configuration with its URDF, and with the joints and frames that are published."""
from __future__ import annotations

from collections import Counter
from typing import NamedTuple

from rbx1_nav.base.robot_parameters import Robot
from rbx1_nav.base.urdf import Tree

PAGE = 'docs/your_robot.md'


class Published(NamedTuple):
    """What is published beside the base itself."""

    joints: dict[str, set[str]]     # names of joints by node, on the topic that robot_state_publisher reads
    frames: set[str]                # child frames of the transforms


def without_prefix(prefix: str, frame: str) -> str:
    """Return a frame without its tf_prefix, which may be ''."""
    return frame[len(prefix) + 1:] if prefix and frame.startswith(f'{prefix}/') else frame


def find_prefix_problem(robot: Robot, prefix: str, tree: Tree) -> str:
    """Return why the links of a model, to which nobody adds the prefix, do not belong to the base, or ''."""
    frame = without_prefix(prefix, robot.base_frame_id)
    if not prefix or robot.base_frame_id in tree.links or frame not in tree.links:
        return ''
    return (f"tf_prefix: {prefix}: the model's links have no prefix: expected robot:={prefix} as an argument of the "
            'launch file, in place of <group ns> and tf_prefix')


def find_problems(robot: Robot, prefix: str, keys: tuple[str, str], tree: Tree, published: Published,
                  reads_base: bool) -> list[str]:
    """Return a line for each thing that does not belong to the rest.

    prefix: tf_prefix of the base; keys: of the base frame and of the controller, for the lines; reads_base: whether
    robot_state_publisher reads the topic on which the base publishes its joints.
    """
    return [*_frame_problems(robot, prefix, keys[0], tree, published), *_joint_problems(
        robot, prefix, keys[1], tree, published, reads_base)]


def _frame_problems(robot: Robot, prefix: str, key: str, tree: Tree, published: Published) -> list[str]:
    links = tree.links | {f'{prefix}/{link}' for link in tree.links}
    roots = {tree.root, f'{prefix}/{tree.root}'}
    if robot.base_frame_id in roots or robot.base_frame_id not in links and roots & published.frames:
        return []       # the second: another node publishes the transform between the two
    problem = (f'not the root of robot_description, so that {robot.base_frame_id} has two parents'
               if robot.base_frame_id in links else 'not a link of robot_description')
    return [f'{key}: {without_prefix(prefix, robot.base_frame_id)}: {problem}: expected its root, '
            f'{without_prefix(prefix, tree.root)}']


def _joint_problems(robot: Robot, prefix: str, key: str, tree: Tree, published: Published,
                    reads_base: bool) -> list[str]:
    own = {*robot.wheel_joints, *(joint.name for joint in robot.joints)}
    by_node = {**published.joints, **({'the base': own} if reads_base else {})}
    counts = Counter(joint for names in by_node.values() for joint in names)
    twice = sorted(joint for joint, count in counts.items() if count > 1)
    problems = []
    if twice:
        nodes = sorted(node for node, names in by_node.items() if names & set(twice))
        problems.append(f'joint_states: {" and ".join(nodes)} publish {", ".join(twice)}, so that the angles '
                        f'alternate: expected the topic of one in the source_list of the other, see {PAGE}')
    frames = {without_prefix(prefix, frame) for frame in published.frames} | published.frames
    missing = [joint for joint, link in tree.movable.items() if joint not in counts and link not in frames]
    absent = [joint for joint in robot.wheel_joints if joint not in tree.movable]
    # wheels of another name, which another node may publish, but which do not turn
    others = sorted(tree.turning - own)
    renamed = len(others) >= len(absent) > 0
    keys = f'left_wheel and right_wheel of {key} (now {" and ".join(robot.wheel_joints)})'
    if missing:
        cures = []
        if renamed:
            cures.append(f'the wheels as {keys}')
        if not renamed or len(others) > len(absent) or set(missing) - set(others):
            cures.append(f'joint_state_publisher{" for the other joints" * renamed}, see {PAGE}')
        problems.append(f'joint_states: nobody publishes {", ".join(missing)}, so that there is no transform to '
                        f'{", ".join(tree.movable[joint] for joint in missing)}: expected {", and ".join(cures)}')
    elif renamed:
        wheels = [joint for joint in others if 'wheel' in joint] or others
        problems.append(f'{keys}: {" and ".join(absent)} is no movable joint of robot_description, so that the wheel '
                        f'does not turn: expected {" or ".join(wheels)}')
    return problems
