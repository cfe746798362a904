"""Reads a URDF file: its visuals, which define the appearance of a robot, and its tree of links."""
from __future__ import annotations

import re
from typing import Mapping, NamedTuple, Tuple
import xml.etree.ElementTree as ElementTree

SHAPES = ('box', 'cylinder', 'sphere', 'mesh')

Numbers = Tuple[float, ...]


class Visual(NamedTuple):
    """A visual of a link."""

    link: str | None        # name of the link
    xyz: Numbers            # position in the frame of the link, m
    rpy: Numbers            # roll, pitch, yaw in the frame of the link, rad
    shape: str              # one of SHAPES
    size: Numbers           # extent along x, y and z, m; for a mesh: its scale
    mesh: str               # URL of the mesh, or ''
    color: Numbers | None   # r, g, b, alpha


def read_visuals(text: str) -> list[Visual]:
    """Return the Visuals in the text of a URDF file. Raises ValueError if it is not a URDF file."""
    try:
        root = ElementTree.fromstring(text)
        if root.tag != 'robot':
            raise ValueError(f'<{root.tag}>: expected <robot>')
        colors = {material.get('name'): material.find('color') for material in root.iter('material')
                  if material.find('color') is not None}
        return [_read_visual(link.get('name'), visual, colors)
                for link in root.findall('link') for visual in link.findall('visual')]
    except (ElementTree.ParseError, KeyError, ValueError) as error:
        raise ValueError(f'not a URDF file: {error}') from error


def _numbers(text: str, count: int = 3) -> Numbers:
    numbers = tuple(float(each) for each in text.split())
    if len(numbers) != count:
        raise ValueError(f'{text!r}: expected {count} numbers')
    return numbers


def _read_visual(link: str | None, visual: ElementTree.Element,
                 colors: Mapping[str | None, ElementTree.Element | None]) -> Visual:
    origin, material = visual.find('origin'), visual.find('material')
    values = {} if origin is None else origin.attrib
    color = None if material is None else material.find('color')
    if color is None and material is not None:
        color = colors.get(material.get('name'))
    shape, = visual.findall('geometry/*')
    if shape.tag not in SHAPES:
        raise ValueError(f"<{shape.tag}>: expected one of {', '.join(SHAPES)}")
    return Visual(link, _numbers(values.get('xyz', '0 0 0')), _numbers(values.get('rpy', '0 0 0')), shape.tag,
                  _size(shape), shape.get('filename', ''), None if color is None else _numbers(color.attrib['rgba'], 4))


def _size(shape: ElementTree.Element) -> Numbers:
    if shape.tag == 'box':
        return _numbers(shape.attrib['size'])
    if shape.tag == 'mesh':
        return _numbers(shape.get('scale', '1 1 1'))
    diameter = 2 * float(shape.attrib['radius'])
    return diameter, diameter, float(shape.get('length', diameter))


class Tree(NamedTuple):
    """The links and joints of a URDF file."""

    root: str               # link that is not the child of a joint
    links: set[str]
    movable: dict[str, str]     # child link by joint, of the joints that robot_state_publisher reads from joint_states
    turning: set[str]       # movable joints without limits, such as wheels


def is_xacro(text: str) -> bool:
    """Return whether a text has to be expanded by xacro before it is a URDF file."""
    return bool(re.search(r'<xacro:(arg|if|include|macro|property|unless)\b|\$\{', text))


def read_tree(text: str) -> Tree:
    """Return the Tree in the text of a URDF file. Raises ValueError if it is not a URDF file."""
    if is_xacro(text):
        raise ValueError('a xacro file, not a URDF file: expected one that xacro has expanded, see '
                         'docs/your_robot.md')
    try:
        robot = ElementTree.fromstring(text)
    except ElementTree.ParseError as error:
        raise ValueError(f'not a URDF file: {error}') from error
    if robot.tag != 'robot':
        raise ValueError(f'not a URDF file: <{robot.tag}>: expected <robot>')
    links = [link.get('name', '') for link in robot.findall('link')]
    children: dict[str, str] = {}
    movable: dict[str, str] = {}
    turning = set()
    for joint in robot.findall('joint'):
        child = joint.find('child')
        name = children[joint.get('name', '')] = '' if child is None else child.get('link', '')
        # the publisher computes a joint that mimics another one
        if joint.get('type') in ('continuous', 'revolute', 'prismatic') and joint.find('mimic') is None:
            movable[joint.get('name', '')] = name
            if joint.get('type') == 'continuous':
                turning.add(joint.get('name', ''))
    if not links:
        raise ValueError('not a URDF file: no <link>: expected at least one')
    roots = [link for link in links if link not in children.values()]
    if len(roots) != 1:
        raise ValueError(f'not a URDF file: links that are no child of a joint: {roots}: expected exactly one')
    return Tree(roots[0], set(links), movable, turning)
