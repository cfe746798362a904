"""Odometry: an arc is an arc, however it is cut."""
from math import cos, hypot, pi, sin

from hypothesis import given
from hypothesis import strategies as st
from pytest import approx

from rbx1_nav.model.kinematics import ORIGIN, Odometry, arc
from rbx1_nav.model.wheels import IdealWheels

speeds = st.floats(-2, 2)
durations = st.floats(0, 10)
fractions = st.floats(0, 1)
# a float has 16 digits; poses are a few metres, and every sum loses a digit or so
CLOSE = dict(abs=1e-12)


@given(speeds, speeds, durations, fractions)
def test_integration_is_additive_over_a_split_interval(linear, angular, duration, fraction):
    part = duration * fraction
    split = arc(arc(ORIGIN, linear * part, angular * part), linear * (duration - part), angular * (duration - part))
    whole = arc(ORIGIN, linear * duration, angular * duration)
    assert split == approx(whole, **CLOSE)


@given(speeds, speeds, durations)
def test_driving_backwards_undoes_it(linear, angular, duration):
    there = arc(ORIGIN, linear * duration, angular * duration)
    assert arc(there, -linear * duration, -angular * duration) == approx(ORIGIN, **CLOSE)


@given(st.floats(-10, 10), st.floats(0.01, 6))
def test_an_arc_lies_on_its_circle(distance, angle):
    radius = distance / angle
    pose = arc(ORIGIN, distance, angle)
    assert pose == approx((radius * sin(angle), radius * (1 - cos(angle)), angle), abs=1e-9 * (1 + abs(radius)))
    assert hypot(pose.x, pose.y - radius) == approx(abs(radius), rel=1e-9)


@given(st.floats(-1, 1), st.floats(1e-5, 1e-3))
def test_the_small_angle_case_joins_the_general_one(distance, angle):
    # the chord is short of the arc by angle^2 / 24
    pose = arc(ORIGIN, distance, angle)
    assert hypot(pose.x, pose.y) == approx(abs(distance) * (1 - angle ** 2 / 24), abs=1e-15)


@given(speeds, speeds, durations)
def test_wheels_and_odometry_are_inverse(linear, angular, duration):
    odometry = Odometry(0.26)
    odometry.update(*IdealWheels(0.26).travel(linear, angular, duration))
    assert odometry.pose == approx(arc(ORIGIN, linear * duration, angular * duration), abs=1e-10)


def test_a_turn_on_the_spot_stays_there():
    odometry = Odometry(0.26)
    odometry.update(*IdealWheels(0.26).travel(0.0, 1.0, pi))
    assert odometry.pose == approx((0, 0, pi), **CLOSE)
