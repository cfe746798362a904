"""The topics of a Create besides those of any base: battery, sensors and buttons, docking, lights and songs; and the
service that resets the odometry.

The names are those of create_robot. Its own message types are replaced by std_msgs.
"""
from __future__ import annotations

from functools import partial
from math import nan
from threading import Lock
from typing import Any, Callable, Mapping

import rospy
from sensor_msgs.msg import BatteryState
from std_msgs.msg import Bool, Empty, Float32, Float32MultiArray, Int16, UInt8, UInt8MultiArray, UInt16
from std_srvs.srv import Empty as EmptyService, EmptyRequest, EmptyResponse

from rbx1_nav.base.clocks import HardwareClock
from rbx1_nav.base.command_gate import RefusedCommand, RejectedCommand
from rbx1_nav.base.robot_parameters import Robot
from rbx1_nav.base.schedule import Schedule
from rbx1_nav.extras.create import protocol
from rbx1_nav.extras.create.create_status import FAULT, HOT, battery_values
from rbx1_nav.extras.create.driver import Driver
from rbx1_nav.extras.create.lights_and_songs import BUTTONS, LEDS, Lights, define_song, play_song
from rbx1_nav.extras.create.protocol import CLIFFS, WHEEL_DROPS
from rbx1_nav.node.rospy_connections import NoDelay

SWITCHES = 'bumps_and_wheel_drops'
# topic, type, packet, bits: a Bool shows whether one of the bits is set, an Empty is published while one is
SENSORS = (
    ('bumper/left', Bool, SWITCHES, protocol.BUMP_LEFT), ('bumper/right', Bool, SWITCHES, protocol.BUMP_RIGHT),
    ('wheeldrop/left', Bool, SWITCHES, protocol.WHEEL_DROP_LEFT),
    ('wheeldrop/right', Bool, SWITCHES, protocol.WHEEL_DROP_RIGHT), ('wheeldrop', Empty, SWITCHES, WHEEL_DROPS),
    *((name.replace('_', '/', 1), Bool, name, 1) for name in CLIFFS),
    *((name, Empty, 'buttons', bit) for name, bit in BUTTONS.items()), ('ir_omni', UInt16, 'infrared', 0xff))
Reading = Mapping[str, int]
# topics below battery/, by their name in battery_values()
BATTERY = {**dict.fromkeys(('voltage', 'current', 'charge', 'capacity', 'charge_ratio'), Float32), 'temperature': Int16}
# by charging state, see create_status; trickle charging keeps a full battery full
POWER_STATUS = (BatteryState.POWER_SUPPLY_STATUS_DISCHARGING, BatteryState.POWER_SUPPLY_STATUS_CHARGING,
                BatteryState.POWER_SUPPLY_STATUS_CHARGING, BatteryState.POWER_SUPPLY_STATUS_FULL,
                BatteryState.POWER_SUPPLY_STATUS_NOT_CHARGING, BatteryState.POWER_SUPPLY_STATUS_NOT_CHARGING)


def battery_state(stamp: rospy.Time, frame: str, reading: Reading) -> BatteryState:
    values = battery_values(reading)
    state = BatteryState(
        percentage=min(values.pop('charge_ratio'), 1.0), power_supply_status=POWER_STATUS[reading['charging_state']],
        present=True, design_capacity=nan, **values)
    state.header.stamp, state.header.frame_id = stamp, frame
    if reading['charging_sources'] and not reading['charging_state']:
        state.power_supply_status = BatteryState.POWER_SUPPLY_STATUS_NOT_CHARGING
    if reading['temperature'] > HOT:
        state.power_supply_health = BatteryState.POWER_SUPPLY_HEALTH_OVERHEAT
    elif reading['charging_state'] == FAULT:
        state.power_supply_health = BatteryState.POWER_SUPPLY_HEALTH_UNSPEC_FAILURE
    return state


class CreateTopics:
    """Publishes what the robot senses, and passes on orders."""

    def __init__(self, driver: Driver, robot: Robot, clock: HardwareClock, lock: Lock) -> None:
        """lock: held while the driver is used."""
        self.driver, self.clock, self.lock = driver, clock, lock
        self.frames = robot.base_frame_id, robot.odom_frame_id
        self.lights = Lights()
        self.battery_schedule = Schedule(1)
        # those of `sensors` with a subscriber: to ask all of them at each reading would cost more than the rest
        self.subscribed: list[tuple[rospy.Publisher, Any, str, int]] = []
        self.is_new = True          # whether a subscriber has connected since `subscribed` was made
        self.power: tuple[int, int] | None = None       # charging state and sources in the last message
        self.sensors = [(rospy.Publisher(name, kind, NoDelay(self.greet), queue_size=10), kind, packet, bits)
                        for name, kind, packet, bits in SENSORS]
        self.battery = rospy.Publisher('battery_state', BatteryState, queue_size=10)
        self.battery_values = {name: rospy.Publisher(f'battery/{name}', kind, queue_size=10)
                               for name, kind in BATTERY.items()}
        self.reset_pub = rospy.Publisher('reset_odometry', Empty, queue_size=1)
        rospy.Service('~reset', EmptyService, self.on_reset)
        self.subscribers: list[rospy.Subscriber] = []

    def subscribe(self) -> None:
        """Accept orders from now on."""
        if self.subscribers:
            return
        orders, lights = self.driver.orders, self.lights
        for name, kind, order in (
                ('dock', Empty, lambda now, _: orders.dock(now)), ('undock', Empty, lambda now, _: orders.undock(now)),
                ('define_song', Float32MultiArray,
                 lambda now, message: orders.send(now, define_song(message.data))),
                ('play_song', UInt8, lambda now, message: orders.send(now, play_song(message.data))),
                *((name, Bool, self.light(partial(lights.set_led, name))) for name in LEDS),
                ('power_led', UInt8MultiArray, self.light(lights.set_power)),
                ('set_ascii', UInt8MultiArray, self.light(lambda data: lights.set_digits(data, self.driver.model)))):
            self.subscribers.append(rospy.Subscriber(name, kind, partial(self.on_order, name, order), queue_size=10))

    def greet(self, *_: object) -> None:
        """Note a new subscriber."""
        self.is_new = True

    # Any: rospy has no types
    def light(self, change: Callable[[Any], None]) -> Callable[[int, Any], None]:
        """Return the order that changes the lights. change(data): changes self.lights."""
        def order(_: int, message: Any) -> None:
            self.driver.orders.check()
            change(message.data)
            self.driver.orders.lights = self.lights.commands
        return order

    def on_order(self, name: str, order: Callable[[int, Any], None], message: Any) -> None:
        """Execute an order, or log why not."""
        try:
            with self.lock:
                order(self.clock.now(), message)
        except (RefusedCommand, RejectedCommand) as error:
            rospy.logwarn('%s: %s; rejected', rospy.resolve_name(name), error)

    def on_reset(self, _: EmptyRequest) -> EmptyResponse:
        """Stop the robot, and put its odometry back at the origin."""
        with self.lock:
            self.driver.reset()
        self.reset_pub.publish()
        rospy.loginfo('Reset: %s is back at the origin of %s', *self.frames)
        return EmptyResponse()

    def publish(self, now: int, stamp: rospy.Time, reading: Reading) -> None:
        """Publish a reading. No message is created without a subscriber."""
        due = self.battery_schedule.due(now)
        if due or self.is_new:
            self.is_new = False
            self.subscribed = [each for each in self.sensors if each[0].get_num_connections()]
        for publisher, kind, packet, bits in self.subscribed:
            value = reading[packet] & bits
            if kind is Bool:
                publisher.publish(bool(value))
            elif kind is UInt16:
                publisher.publish(value % protocol.NOTHING_RECEIVED)
            elif value:
                publisher.publish()
        power = reading['charging_state'], reading['charging_sources']
        if due or power != self.power:
            self.power = power
            if self.battery.get_num_connections():
                self.battery.publish(battery_state(stamp, self.frames[0], reading))
            values = battery_values(reading)
            for name, publisher in self.battery_values.items():
                if publisher.get_num_connections():
                    publisher.publish(values[name])
