"""Each topic of the Create shows what the robot senses, and no message is created without a subscriber."""
from math import isnan
import threading
from types import SimpleNamespace

import pytest
import rospy
from sensor_msgs.msg import BatteryState

from fake_topics import Topic, replace_topics
from rbx1_nav.base.robot_parameters import Limits
from rbx1_nav.extras.create.create_topics import CreateTopics, battery_state
from rbx1_nav.extras.create.protocol import CREATE, MODELS

from driven_create import BOTH, started

STAMP = rospy.Time(5)
BITS = {'bumper/right': 1, 'bumper/left': 2, 'wheeldrop/right': 4, 'wheeldrop/left': 8}
CLIFF_BITS = {'cliff/left': 1, 'cliff/front_left': 2, 'cliff/front_right': 4, 'cliff/right': 8}
BUTTON_BITS = {'clean_button': 1, 'spot_button': 2, 'dock_button': 4, 'minute_button': 8, 'hour_button': 16,
               'day_button': 32}


@pytest.fixture
def node(monkeypatch):
    """A function that returns (DrivenCreate, CreateTopics, {name: Topic})."""
    def make(robot_type):
        topics = replace_topics(monkeypatch)
        driven = started(robot_type)
        robot = SimpleNamespace(base_frame_id='base_footprint', odom_frame_id='odom', limits=Limits(1, 1))
        clock = SimpleNamespace(now=lambda: driven.now)
        found = CreateTopics(driven.driver, robot, clock, threading.Lock())
        found.subscribe()
        found.subscribe()   # has no effect
        return driven, found, topics
    return make


def published(driven, found, topics, names):
    """Run until the sensors are read; return what is then published, {name: messages}."""
    driven.run(0.1)
    for name in names:
        topics[name].sent.clear()
    found.publish(driven.now, STAMP, driven.driver.reading)
    return {name: topics[name].sent[:] for name in names}


@BOTH
def test_each_sensor_has_its_own_topic(node, robot_type):
    driven, found, topics = node(robot_type)
    quiet = {**dict.fromkeys((*BITS, *CLIFF_BITS), [False]), **dict.fromkeys(('wheeldrop', *BUTTON_BITS), []),
             'ir_omni': [0]}
    assert published(driven, found, topics, quiet) == quiet
    for attribute, table in ('switches', BITS), ('cliffs', CLIFF_BITS), ('buttons', BUTTON_BITS):
        for name, bit in table.items():
            setattr(driven.body, attribute, bit)
            shown = {name: [True]}
            if attribute == 'buttons':      # an event; a Create has fewer buttons
                shown = {name: [None] if bit <= MODELS[robot_type].packets[18].high else []}
            elif name.startswith('wheeldrop'):
                shown['wheeldrop'] = [None]
            assert published(driven, found, topics, quiet) == {**quiet, **shown}
        setattr(driven.body, attribute, 0)
    driven.body.infrared = 248
    assert published(driven, found, topics, quiet) == {**quiet, 'ir_omni': [248]}


@BOTH
def test_a_message_of_each_battery_topic_per_second_and_when_the_charger_changes(node, robot_type):
    driven, found, topics = node(robot_type)
    names = [f'battery/{name}' for name in ('voltage', 'current', 'charge', 'capacity', 'charge_ratio', 'temperature')]
    values = published(driven, found, topics, names)
    assert [round(values[name][0], 2) for name in names] == [16.5, -0.3, 3.0, 3.0, 1.0, 25]
    assert topics['battery_state'].sent[-1].header.stamp == STAMP
    assert published(driven, found, topics, ['battery_state']) == {'battery_state': []}
    driven.body.docked = True
    (state,) = published(driven, found, topics, ['battery_state'])['battery_state']
    assert state.power_supply_status in (state.POWER_SUPPLY_STATUS_CHARGING, state.POWER_SUPPLY_STATUS_FULL)
    assert published(driven, found, topics, ['battery_state']) == {'battery_state': []}
    driven.run(1)
    assert len(published(driven, found, topics, ['battery_state'])['battery_state']) == 1


READING = {'charging_state': 0, 'charging_sources': 0, 'charge': 1500, 'capacity': 3000, 'temperature': 25,
           'voltage': 14500, 'current': -800}


def test_a_battery_state():
    state = battery_state(STAMP, 'base_footprint', READING)
    assert (state.voltage, state.current, state.charge, state.capacity, state.percentage, state.temperature) == (
        14.5, -0.8, 1.5, 3.0, 0.5, 25)
    assert state.present and isnan(state.design_capacity) and state.header.frame_id == 'base_footprint'
    assert state.power_supply_health == state.POWER_SUPPLY_HEALTH_UNKNOWN


@pytest.mark.parametrize('changes, status, health', [
    ({}, 'DISCHARGING', 'UNKNOWN'), ({'charging_sources': 2}, 'NOT_CHARGING', 'UNKNOWN'),
    ({'charging_sources': 2, 'charging_state': 1}, 'CHARGING', 'UNKNOWN'),
    ({'charging_sources': 1, 'charging_state': 2}, 'CHARGING', 'UNKNOWN'),
    ({'charging_sources': 2, 'charging_state': 3}, 'FULL', 'UNKNOWN'),
    ({'charging_sources': 2, 'charging_state': 4}, 'NOT_CHARGING', 'UNKNOWN'),
    ({'charging_sources': 2, 'charging_state': 5}, 'NOT_CHARGING', 'UNSPEC_FAILURE'),
    ({'temperature': 61}, 'DISCHARGING', 'OVERHEAT')])
def test_the_status_of_the_battery(changes, status, health):
    state = battery_state(STAMP, '', {**READING, **changes})
    assert state.power_supply_status == getattr(BatteryState, f'POWER_SUPPLY_STATUS_{status}')
    assert state.power_supply_health == getattr(BatteryState, f'POWER_SUPPLY_HEALTH_{health}')


def test_an_unknown_and_an_underestimated_capacity():
    assert isnan(battery_state(STAMP, '', {**READING, 'capacity': 0}).percentage)
    assert battery_state(STAMP, '', {**READING, 'charge': 3100}).percentage == 1


def test_no_message_without_a_subscriber_and_a_new_one_gets_the_next_reading(node, monkeypatch):
    driven, found, topics = node('create2')
    monkeypatch.setattr(Topic, 'connections', 0)
    driven.body.switches, driven.body.buttons = 15, 5
    driven.run(2)
    published(driven, found, topics, BITS)
    assert [name for name, topic in topics.items() if topic.sent] == []
    monkeypatch.setattr(Topic, 'connections', 1)
    found.greet('/bumper/left', None)
    assert published(driven, found, topics, BITS) == {name: [True] for name in BITS}


def order(topics, name, data=None):
    topics[name].callback(SimpleNamespace(data=data))


@pytest.mark.parametrize('name, data, text', [
    ('undock', None, 'the robot is not on its dock'), ('define_song', [9, 60, 1], 'song 9: expected'),
    ('play_song', 9, 'song 9: expected'), ('power_led', b'', 'expected a color'),
    ('set_ascii', b'Go', 'a create has none')])
def test_a_rejected_order_is_logged_in_one_line(node, monkeypatch, name, data, text):
    driven, _, topics = node(CREATE.name)
    lines = []
    monkeypatch.setattr(rospy, 'logwarn', lambda form, *values: lines.append(form % values))
    before = driven.driver.orders.lights
    order(topics, name, data)
    assert len(lines) == 1 and lines[0].startswith(f'/{name}: ') and text in lines[0]
    assert lines[0].endswith('; rejected') and driven.driver.orders.lights == before


def test_lights_of_a_robot_that_does_not_answer_are_rejected(node, monkeypatch):
    driven, _, topics = node('create2')
    lines = []
    monkeypatch.setattr(rospy, 'logwarn', lambda form, *values: lines.append(form % values))
    driven.line.silent = True
    driven.run(1)
    order(topics, 'spot_led', True)
    assert lines == ['/spot_led: the robot does not answer; rejected'] and not driven.driver.orders.lights


@BOTH
def test_reset_puts_the_odometry_at_the_origin_and_stops_the_robot(node, robot_type):
    driven, _, topics = node(robot_type)
    driven.drive(0.2, 0.3, 1)
    topics['~reset'].callback(None)
    assert (driven.pose.x, driven.pose.y, driven.pose.yaw) == (0, 0, 0) and topics['reset_odometry'].sent == [None]
    driven.run(1)
    assert not driven.body.moving
    # 40 ms at 0.2 m/s and 0.3 rad/s until the robot has stopped; a Create counts whole degrees
    assert abs(driven.pose.x) < 0.02 and abs(driven.pose.yaw) < 0.05
    driven.drive(0.2, 0, 1)
    assert driven.pose.x > 0.15
