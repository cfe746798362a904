"""Reports the state of a Create on /diagnostics: base, battery, sensors, gyro and serial line."""
from __future__ import annotations

from math import isnan, nan
from typing import Mapping

import rospy
from diagnostic_msgs.msg import DiagnosticStatus
from diagnostic_updater import DiagnosticStatusWrapper, Updater

from rbx1_nav.base.command_subscriber import VelocityCommands
from rbx1_nav.base.messages import fill_status
from rbx1_nav.extras.create import protocol
from rbx1_nav.extras.create.driver import Driver
from rbx1_nav.extras.create.odometry import CounterTravel
from rbx1_nav.extras.create.protocol import BUMPS, CLIFFS, WHEEL_DROPS
from rbx1_nav.extras.create.serial_port import Link

LOW, EMPTY = 0.2, 0.05      # levels of the battery's charge, fractions of its capacity
OVERFULL = 1.1      # the capacity is an estimate of the robot, so a full battery may exceed it a little
HOT = 60            # degrees C, usual limit of NiMH and lithium-ion cells during discharge
FLAT = 10800        # mV: 12 NiMH cells with 0.9 V each, which are empty
FAULT = 5           # charging state
CHARGING_STATES = ('not charging', 'reconditioning', 'charging', 'trickle charging', 'waiting', 'charging fault')
SWITCHES = {'Bumper left': protocol.BUMP_LEFT, 'Bumper right': protocol.BUMP_RIGHT,
            'Wheel drop left': protocol.WHEEL_DROP_LEFT, 'Wheel drop right': protocol.WHEEL_DROP_RIGHT,
            'Wheel drop castor': protocol.WHEEL_DROP_CASTOR}
OK, WARN, ERROR = DiagnosticStatus.OK, DiagnosticStatus.WARN, DiagnosticStatus.ERROR
NO_ANSWER = ERROR, 'The robot does not answer'


def battery_values(reading: Mapping[str, int]) -> dict[str, float]:
    """Return the values of the battery in V, A, Ah and degrees C, and the charge as a part of the capacity, which the
    robot estimates; nan if it is unknown."""
    values = {name: reading[name] / 1000 for name in ('voltage', 'current', 'charge', 'capacity')}
    return {**values, 'temperature': reading['temperature'],
            'charge_ratio': reading['charge'] / reading['capacity'] if reading['capacity'] else nan}


def battery_status(reading: Mapping[str, int]) -> tuple[int, str]:
    """Return the level and the summary of the battery's status: its worst problem."""
    charge, state = battery_values(reading)['charge_ratio'], reading['charging_state']
    percent = f'{100 * charge:.0f} %'
    docked = isnan(charge) or reading['charging_sources']
    found = [(OK, CHARGING_STATES[state] if docked else percent)]
    if state == FAULT:
        found.append((ERROR, CHARGING_STATES[FAULT]))
    if reading['temperature'] > HOT:
        found.append((ERROR, f"{reading['temperature']} degrees C: expected at most {HOT}"))
    if charge < LOW and state == 0:
        found.append((ERROR if charge < EMPTY else WARN, f'Low: {percent}'))
    if charge > OVERFULL:
        found.append((WARN, f'{percent}: expected at most {100 * OVERFULL:.0f} %'))
    if reading['voltage'] < FLAT:
        found.append((WARN, f"{reading['voltage'] / 1000:g} V: expected at least {FLAT / 1000:g} V"))
    return max(found, key=lambda each: each[0])


class CreateStatus:
    """Fills in the DiagnosticStatus of each part."""

    def __init__(self, updater: Updater, driver: Driver, link: Link, commands: VelocityCommands) -> None:
        self.driver, self.link, self.commands = driver, link, commands
        self.battery_level = OK     # the last one
        self.updater = updater
        self.shows_gyro = False     # True as soon as a robot with a gyro has been found
        updater.setHardwareID(link.path)
        for title, function in (('Base', self.base), ('Battery', self.battery), ('Sensors', self.sensors),
                                ('Serial line', self.line)):
            updater.add(title, function)

    def update(self) -> None:
        if self.driver.gyro and self.driver.contact.found and not self.shows_gyro:
            self.shows_gyro = True
            self.updater.add('Gyro', self.gyro)
        self.updater.force_update()

    def base(self, status: DiagnosticStatusWrapper) -> DiagnosticStatusWrapper:
        driver, supervisor = self.driver, self.driver.supervisor
        if self.link.problem:
            summary = ERROR, self.link.problem
        elif not driver.contact.answers:
            summary = NO_ANSWER
        elif not supervisor.in_control:
            summary = WARN, f"Not driven: {supervisor.reason or 'changing the mode'}"
        else:
            summary = OK, 'Stationary' if driver.motion.stands else 'Moving'
        found, mode = driver.contact.found, supervisor.mode
        fill_status(status, *summary, {
            'Robot type': found.model.name if found else 'unknown',
            **({'Fractions of a degree': driver.counter.fractions.known} if isinstance(driver.counter, CounterTravel)
               else {}),
            'Mode': 'unknown' if mode is None else protocol.MODE_NAMES[mode],
            'Speed of the left wheel (mm/s)': driver.sender.speeds[0],
            'Speed of the right wheel (mm/s)': driver.sender.speeds[1],
            # for the calibration scripts: the parameters may have been set since the base was started
            'odom_linear_scale_correction': driver.settings.odom_linear_scale_correction,
            'odom_angular_scale_correction': driver.settings.odom_angular_scale_correction})
        self.commands.diagnose(status)
        return status

    def battery(self, status: DiagnosticStatusWrapper) -> DiagnosticStatusWrapper:
        reading = self._reading(status)
        if not reading:
            return status
        level, text = battery_status(reading)
        if level > self.battery_level:
            rospy.logwarn('Battery: %s%s', text, ': charge it soon' if text.startswith('Low') else '')
        self.battery_level = level
        values = battery_values(reading)
        return fill_status(status, level, text, {
            'Voltage (V)': values['voltage'],
            'Current (A)': values['current'],
            'Charge (Ah)': values['charge'],
            'Capacity (Ah)': values['capacity'],
            'Temperature (degrees C)': reading['temperature'],
            'Charging state': CHARGING_STATES[reading['charging_state']],
            'Charging sources': reading['charging_sources']})

    def sensors(self, status: DiagnosticStatusWrapper) -> DiagnosticStatusWrapper:
        """Fill in the status of bumpers, wheel drops and cliff sensors."""
        reading = self._reading(status)
        if not reading:
            return status
        bits = reading['bumps_and_wheel_drops']
        found = [name for name, mask in (('bumper', BUMPS), ('wheel drop', WHEEL_DROPS)) if bits & mask]
        found += [name.replace('_', ' ') for name in CLIFFS if reading[name]]
        return fill_status(status, WARN if found else OK, ', '.join(found) or 'No bump, wheel drop or cliff', {
            **{name: bool(bits & bit) for name, bit in SWITCHES.items()},
            **{name.replace('_', ' ').capitalize(): bool(reading[name]) for name in (*CLIFFS, 'wall', 'virtual_wall')},
            'Overcurrents': reading['overcurrents']})

    def gyro(self, status: DiagnosticStatusWrapper) -> DiagnosticStatusWrapper:
        """Fill in the status of the gyro: its current reading and its offset."""
        gyro, reading = self.driver.gyro, self.driver.reading
        if not gyro:
            return status
        summary = ((ERROR, gyro.problem) if gyro.problem else
                   (WARN, 'Not calibrated: keep the robot stationary') if gyro.offset is None else (OK, 'Calibrated'))
        return fill_status(status, *summary, {
            **({'Reading (counts)': reading['analog_input']} if reading else {}),
            **({} if gyro.offset is None else {'Offset (counts)': f'{gyro.offset:.2f}'}),
            'Readings at rest': len(gyro.rest),
            'gyro_scale_correction': self.driver.settings.gyro_scale_correction})

    def line(self, status: DiagnosticStatusWrapper) -> DiagnosticStatusWrapper:
        driver, link = self.driver, self.link
        level = ERROR if link.problem or not driver.contact.answers else OK
        return fill_status(status, level, link.problem or 'Open', {
            'Port': link.path,
            'Adapter': link.adapter or 'unknown',
            'Rate (baud)': link.baud,
            'Corrupted readings': driver.queries.rejected,
            'Implausible readings': driver.implausible,
            'Lost replies': driver.queries.missed,
            'Dropouts': driver.contact.dropouts})

    def _reading(self, status: DiagnosticStatusWrapper) -> Mapping[str, int] | None:
        if not self.driver.contact.answers:
            status.summary(*NO_ANSWER)
            return None
        return self.driver.reading
