"""Odometry integrates exact arcs, in any number of steps."""
from math import cos, hypot, sin

from hypothesis import given
from hypothesis import strategies as st
from pytest import approx

from rbx1_nav.base.kinematics import ORIGIN, Odometry, arc
from rbx1_nav.simulation.wheels import IdealWheels

speeds = st.floats(-2, 2)
durations = st.floats(0, 10)
fractions = st.floats(0, 1)
# a float has 16 digits; poses are a few meters, and each sum loses about one digit
CLOSE = dict(abs=1e-12)


@given(speeds, speeds, durations, fractions)
def test_an_arc_in_two_parts_ends_where_the_whole_arc_ends(linear, angular, duration, fraction):
    part = duration * fraction
    split = arc(arc(ORIGIN, linear * part, angular * part), linear * (duration - part), angular * (duration - part))
    whole = arc(ORIGIN, linear * duration, angular * duration)
    assert split == approx(whole, **CLOSE)


@given(st.floats(-10, 10), st.floats(0.01, 6))
def test_an_arc_lies_on_its_circle(distance, angle):
    radius = distance / angle
    pose = arc(ORIGIN, distance, angle)
    assert pose == approx((radius * sin(angle), radius * (1 - cos(angle)), angle), abs=1e-9 * (1 + abs(radius)))
    assert hypot(pose.x, pose.y - radius) == approx(abs(radius), rel=1e-9)


@given(st.floats(-1, 1), st.floats(1e-5, 1e-3))
def test_the_series_for_small_angles_agrees_with_the_chord(distance, angle):
    # the chord is shorter than the arc by the factor angle^2 / 24
    pose = arc(ORIGIN, distance, angle)
    assert hypot(pose.x, pose.y) == approx(abs(distance) * (1 - angle ** 2 / 24), abs=1e-15)


@given(speeds, speeds, durations)
def test_odometry_recovers_the_motion_from_the_travel_of_the_wheels(linear, angular, duration):
    odometry = Odometry(0.26)
    odometry.update(*IdealWheels(0.26).travel(linear, angular, duration))
    assert odometry.pose == approx(arc(ORIGIN, linear * duration, angular * duration), abs=1e-10)
