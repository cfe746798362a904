"""The functions that the scripts of the book import from rbx1_nav.transform_utils."""
from collections import namedtuple
from math import cos, pi, sin

import pytest
from rbx1_nav.transform_utils import normalize_angle, quat_to_angle

Quaternion = namedtuple('Quaternion', 'x y z w')


def product(a, b):
    """The quaternion of the rotation b followed by the rotation a."""
    return Quaternion(a.w * b.x + a.x * b.w + a.y * b.z - a.z * b.y, a.w * b.y - a.x * b.z + a.y * b.w + a.z * b.x,
                      a.w * b.z + a.x * b.y - a.y * b.x + a.z * b.w, a.w * b.w - a.x * b.x - a.y * b.y - a.z * b.z)


def rotation(roll, pitch, yaw):
    """The quaternion of roll, then pitch, then yaw about fixed axes."""
    axes = (Quaternion(0, 0, sin(yaw / 2), cos(yaw / 2)), Quaternion(0, sin(pitch / 2), 0, cos(pitch / 2)),
            Quaternion(sin(roll / 2), 0, 0, cos(roll / 2)))
    return product(product(axes[0], axes[1]), axes[2])


@pytest.mark.parametrize('yaw', [-3.1, -pi / 2, -1e-9, 0, 0.5, pi / 2, 3.14])
@pytest.mark.parametrize('roll, pitch', [(0, 0), (0.3, 0), (0, -0.4), (0.3, 1.2)])
def test_the_heading_of_a_quaternion(roll, pitch, yaw):
    quaternion = rotation(roll, pitch, yaw)
    assert quat_to_angle(quaternion) == pytest.approx(yaw, abs=1e-12)
    # tf and others round: the length is not exactly 1
    assert quat_to_angle(Quaternion(*(1.001 * each for each in quaternion))) == pytest.approx(yaw, abs=1e-12)


@pytest.mark.parametrize('angle, normal', [
    (0, 0), (pi, pi), (-pi, -pi), (1.5 * pi, -pi / 2), (-1.5 * pi, pi / 2), (2 * pi + 0.1, 0.1), (-20 * pi - 3, -3)])
def test_the_angle_between_minus_pi_and_pi(angle, normal):
    assert normalize_angle(angle) == pytest.approx(normal, abs=1e-12)
