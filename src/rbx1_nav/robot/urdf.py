"""What a robot looks like: the visuals of a URDF file."""
from collections import namedtuple
import xml.etree.ElementTree as ElementTree

Visual = namedtuple('Visual', 'link xyz rpy shape size mesh color')
Visual.__doc__ = """A visual of a link: position (m) and roll, pitch, yaw (rad) in the frame of the link; shape: one of
SHAPES; size: extent along x, y and z (m; of a mesh: its scale); mesh: its URL, or ''; color: r, g, b, alpha, or None."""

SHAPES = ('box', 'cylinder', 'sphere', 'mesh')


def read_visuals(text):
    """The Visuals in the text of a URDF file. Raises ValueError if it is not one."""
    try:
        root = ElementTree.fromstring(text)
        if root.tag != 'robot':
            raise ValueError(f'<{root.tag}>: expected <robot>')
        colors = {material.get('name'): material.find('color') for material in root.iter('material')
                  if material.find('color') is not None}
        return [_read_visual(link.get('name'), visual, colors)
                for link in root.findall('link') for visual in link.findall('visual')]
    except (ElementTree.ParseError, AttributeError, IndexError, TypeError, ValueError) as error:
        raise ValueError(f'not a URDF file: {error}')


def _numbers(text, count=3):
    numbers = tuple(float(each) for each in text.split())
    if len(numbers) != count:
        raise ValueError('%r: expected %d numbers' % (text, count))
    return numbers


def _read_visual(link, visual, colors):
    origin, material = visual.find('origin'), visual.find('material')
    values = {} if origin is None else origin.attrib
    color = None if material is None else material.find('color')
    if color is None and material is not None:
        color = colors.get(material.get('name'))
    shape, = visual.find('geometry')
    if shape.tag not in SHAPES:
        raise ValueError(f"<{shape.tag}>: expected one of {', '.join(SHAPES)}")
    return Visual(link, _numbers(values.get('xyz', '0 0 0')), _numbers(values.get('rpy', '0 0 0')), shape.tag,
                  _size(shape), shape.get('filename', ''), None if color is None else _numbers(color.get('rgba'), 4))


def _size(shape):
    if shape.tag == 'box':
        return _numbers(shape.get('size'))
    if shape.tag == 'mesh':
        return _numbers(shape.get('scale', '1 1 1'))
    diameter = 2 * float(shape.get('radius'))
    return diameter, diameter, float(shape.get('length', diameter))
