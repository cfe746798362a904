"""An emulated Create with the parameters of a node, and services and topics that trigger events on it, such as a pulled
cable or a dropped wheel."""
from __future__ import annotations

from functools import partial
from math import floor
from threading import Lock
from typing import Callable

import rospy
from std_msgs.msg import Float64
from std_srvs.srv import SetBool, SetBoolResponse, Trigger, TriggerResponse

from rbx1_nav.extras.create.emulator.body import CAPACITY, Body, BodyErrors
from rbx1_nav.extras.create.emulator.emulator import EmulatedCreate
from rbx1_nav.extras.create.emulator.serial_line import PseudoTerminal, SerialLine
from rbx1_nav.extras.create.protocol import BAUD_RANGE, BAUD_RATES, BUMPS, CREATE, MODELS, WHEEL_DROP_LEFT
from rbx1_nav.node.config import ConfigError, Section, YamlValue, show
from rbx1_nav.node.parameters import Parameter, choice, custom, flag, number, read
from rbx1_nav.node.private_parameters import param
from rbx1_nav.simulation.floor_parameters import SURFACE, seed


def _check_link(link: YamlValue) -> str:
    if not isinstance(link, str):
        raise ConfigError(f'link: {show(link)}: expected a path')
    return link


_BODY = {
    'gyro_sensitivity': "ratio of the gyro's sensitivity to its nominal value",
    'wheel_travel': 'ratio of the counted distance to the traveled distance',
    'wheel_base': 'ratio of the true wheel separation to its nominal value'}
_BITS = {
    'switches': ('bits of packet 7: bumper right 1, left 2, wheel drop right 4, left 8, caster 16', 31),
    'cliffs': ('bits of the cliff sensors: left 1, front left 2, front right 4, right 8', 15),
    'buttons': ('bits of packet 18: clean (play) 1, spot 2, dock (advance) 4, minute 8, hour 16, day 32', 255)}

PARAMETERS = (
    choice('robot_type', tuple(MODELS), CREATE.name, 'model of the robot'),
    choice('baud', BAUD_RATES, None, 'rate after the robot is switched on; 19200: its power button was held',
           'bits per second', shown=f'{CREATE.name}: {CREATE.baud}; others: {MODELS["create2"].baud}')._replace(
               range=BAUD_RANGE),
    custom('link', '', 'path of a symbolic link to the device', _check_link, shown='none',
           note="the log shows the device's name"),
    SURFACE,
    seed('slip, gyro errors and corruption'),
    number('charge', 1.0, '', 'reported charge, as a fraction of the capacity', 0, 2),
    number('battery_temperature', 25.0, 'degrees C', 'temperature of the battery', -40, 100, 'a temperature'),
    number('battery_voltage', 0.0, 'V', 'voltage of the battery; 0: it follows the charge', 0, 25, 'a voltage'),
    *(number(name, 0.0, '', text, 0, high, 'a number') for name, (text, high) in _BITS.items()),
    number('corruption', 0.0, '', 'fraction of the bytes to the host that are flipped, lost or doubled', 0, 1),
    number('gyro_measurement_range', 150.0, 'degrees/s', 'full-scale turn rate of the gyro', 1, 1e5),
    *(number(name, 1.0, '', _BODY[name], 0.1, 10, 'a factor') for name in BodyErrors._fields),
    number('gyro_stuck', -1.0, '', 'count at which the analog input is stuck; -1: it is not stuck', -1, 1023,
           'a count'),
    flag('mode_plus_one', False, 'whether the robot reports its mode plus one, like a Roomba with Wi-Fi'),
    flag('drops_fractions', False, 'whether each reading of the angle loses the fraction of a degree'))

# parameters that a topic can change: what they set, a part of the robot and its attribute, and the conversion
CHANGEABLE: dict[str, tuple[str, str, Callable[[float], float]]] = {
    'charge': ('body', 'charge', lambda value: value * CAPACITY),
    'battery_temperature': ('body', 'temperature', round),
    'battery_voltage': ('body', 'voltage', lambda value: round(1000 * value)),
    **{name: ('body', name, int) for name in _BITS},
    'corruption': ('line', 'corruption', float),
    'gyro_stuck': ('body', 'gyro_stuck', floor)}
# services that switch bits of an attribute of a part of the robot
SWITCHES = {
    'silence': ('line', 'silent', True), 'drop_wheel': ('body', 'switches', WHEEL_DROP_LEFT),
    'cliff': ('body', 'cliffs', 0b0110), 'bump': ('body', 'switches', BUMPS), 'dock': ('body', 'docked', True),
    'charger': ('body', 'charger', True), 'charging_fault': ('body', 'charging_fault', True)}


def _set(robot: EmulatedCreate, name: str, value: float) -> None:
    part, attribute, convert = CHANGEABLE[name]
    setattr(getattr(robot, part), attribute, convert(value))


def _switch(robot: EmulatedCreate, name: str, on: bool) -> None:
    part, attribute, bits = SWITCHES[name]
    others = getattr(getattr(robot, part), attribute) & ~bits
    setattr(getattr(robot, part), attribute, others | bits if on else others)


def make_robot(now: int) -> EmulatedCreate:
    """Return an EmulatedCreate with the parameters of this node. now: ns."""
    model = MODELS[param('robot_type')]
    model = model._replace(mode_plus_one=model.mode_plus_one or param('mode_plus_one'))
    body = Body(model, param('surface'), param('seed'), BodyErrors(*map(param, BodyErrors._fields)),
                param('gyro_measurement_range'), param('drops_fractions'))
    robot = EmulatedCreate(body, SerialLine(param('baud') or model.baud, param('seed')), now)
    for name in CHANGEABLE:
        _set(robot, name, param(name))
    return robot


class RobotFaults:
    """The services and topics."""

    def __init__(self, robot: EmulatedCreate, terminal: PseudoTerminal, lock: Lock) -> None:
        """lock: held while the robot or the terminal is used."""
        self.robot, self.terminal, self.lock = robot, terminal, lock

    def serve(self) -> None:
        """Offer the services and topics."""
        self._offer_switch('pull_cable', lambda on: self.terminal.unplug() if on else self.terminal.plug())
        for name in SWITCHES:
            self._offer_switch(name, partial(_switch, self.robot, name))
        rospy.Service('~power_cycle', Trigger, lambda _: TriggerResponse(
            *self._change('power_cycle', lambda: self.robot.switch_on(self.robot.now))))
        for each in PARAMETERS:
            if each.name in CHANGEABLE:
                rospy.Subscriber(f'~{each.name}', Float64, self._on_number, each)

    def _offer_switch(self, name: str, switch: Callable[[bool], None]) -> None:
        rospy.Service(f'~{name}', SetBool, lambda request: SetBoolResponse(
            *self._change(f'{name}: {request.data}', lambda: switch(request.data))))

    def _on_number(self, message: Float64, parameter: Parameter) -> None:
        name = parameter.name
        try:
            read([parameter], Section({name: message.data}, rospy.get_name()))
        except ConfigError as error:
            rospy.logerr('%s; rejected', error)
        else:
            self._change(f'{name}: {message.data:g}', lambda: _set(self.robot, name, message.data))

    def _change(self, text: str, function: Callable[[], object]) -> tuple[bool, str]:
        """Call a function; return whether it succeeded, and the text that is logged."""
        try:
            with self.lock:
                function()
        except ConfigError as error:    # the link cannot be created any more
            text = f'{text}: {error}'
            rospy.logerr('%s', text)
            return False, text
        rospy.loginfo('%s', text)
        return True, text
