"""The pose of one odometry frame in another follows from two poses of the same robot."""
from cmath import rect
from math import pi

from hypothesis import given
from hypothesis import strategies as st
from pytest import approx

from rbx1_nav.base.kinematics import Pose, relative_frame

poses = st.builds(Pose, st.floats(-10, 10), st.floats(-10, 10), st.floats(-2 * pi, 2 * pi))


@given(poses, poses)
def test_the_robot_has_one_place_in_both_frames(pose, other):
    frame = relative_frame(pose, other)
    # a point of the other frame, as a complex number, is rotated and shifted
    place = complex(frame.x, frame.y) + rect(1, frame.yaw) * complex(other.x, other.y)
    # rounding of coordinates up to 30 m
    assert (place.real, place.imag, frame.yaw + other.yaw) == approx(pose, abs=1e-13)
