"""The visuals of a URDF file are read, and other text is rejected."""
import os

import pytest

from rbx1_nav.base.urdf import Visual, read_visuals

GEOMETRY = '<robot><link name="a"><visual><geometry>%s</geometry></visual></link></robot>'
FOLDER = os.path.join(os.path.dirname(__file__), '..', '..', '..', 'urdf')


@pytest.mark.parametrize('name, count', [('turtlebot.urdf', 24), ('pi_robot.urdf', 25)])
def test_the_robots_of_this_package_are_read(name, count):
    with open(os.path.join(FOLDER, name)) as file:
        text = file.read()
    visuals = read_visuals(text)
    assert len(visuals) == text.count('<visual>') == count
    assert all(len(each.color) == 4 and len(each.size) == 3 and min(each.size) > 0 for each in visuals)


def test_shapes_sizes_and_colors():
    visuals = read_visuals('''
        <robot name="test">
          <material name="red"><color rgba="1 0 0 0.5"/></material>
          <link name="empty"/>
          <link name="body">
            <visual>
              <origin xyz="1 2 3" rpy="0 0 1.5"/>
              <geometry><cylinder radius="0.1" length="0.3"/></geometry>
              <material name="red"/>
            </visual>
            <visual><geometry><sphere radius="0.2"/></geometry></visual>
            <visual>
              <geometry><box size="1 2 3"/></geometry>
              <material name=""><color rgba="0 1 0 1"/></material>
            </visual>
            <visual>
              <geometry><mesh filename="package://a/b.dae" scale="2 2 2"/></geometry>
              <material name=""><color rgba="0 0 1 1"/></material>
            </visual>
          </link>
        </robot>''')
    origin = (0, 0, 0)
    assert visuals == [
        Visual('body', (1, 2, 3), (0, 0, 1.5), 'cylinder', (0.2, 0.2, 0.3), '', (1, 0, 0, 0.5)),
        Visual('body', origin, origin, 'sphere', (0.4, 0.4, 0.4), '', None),
        Visual('body', origin, origin, 'box', (1, 2, 3), '', (0, 1, 0, 1)),
        Visual('body', origin, origin, 'mesh', (2, 2, 2), 'package://a/b.dae', (0, 0, 1, 1))]


@pytest.mark.parametrize('text', ['', 'robot', '<html/>', '<robot><link name="a"><visual/></link></robot>',
                                  GEOMETRY % '<box size="b"/>', GEOMETRY % '<box size="1 2"/>',
                                  GEOMETRY % '<capsule radius="1" length="2"/>'])
def test_other_text_is_rejected(text):
    with pytest.raises(ValueError, match='not a URDF file'):
        read_visuals(text)
