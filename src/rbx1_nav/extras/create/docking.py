"""What the owner of a robot orders besides motion: to dock, to leave the dock, songs and lights. All times are in ns.

The robot docks by itself, in passive mode. On its charger it falls back from safe to passive mode, so the driver takes
it off the dock in full mode, where neither a cliff nor a wheel drop stops the robot: here the driver checks both.
"""
from __future__ import annotations

from typing import Callable, Mapping

from rbx1_nav.base.command_gate import CommandGate, RefusedCommand
from rbx1_nav.base.units import SECOND
from rbx1_nav.extras.create import protocol, sequences
from rbx1_nav.extras.create.connection import RETRY, Contact, Supervisor, causes
from rbx1_nav.extras.create.create_parameters import Settings
from rbx1_nav.extras.create.protocol import DOCK
from rbx1_nav.extras.create.sender import Kind, Phase, Sender

UNDOCK_SPEED = 0.1          # m/s
UNDOCK_DISTANCE = 0.2       # m, after which the robot can turn beside its dock
UNDOCK_TIME = 5 * SECOND    # in which it must have driven this distance
DOCKING, UNDOCKING, BACKING = 'docking', 'undocking', 'backing away from the dock'      # states; '' for none of them


class Orders:
    """Executes the orders. A command on cmd_vel, and whatever stops the robot, ends docking and undocking."""

    def __init__(self, settings: Settings, gate: CommandGate, sender: Sender, contact: Contact, supervisor: Supervisor,
                 info: Callable[[str], None], warn: Callable[[str], None]) -> None:
        self.wanted = settings.operation_mode
        self.gate = gate
        self.sender = sender
        self.contact = contact
        self.supervisor = supervisor
        self.info = info
        self.warn = warn
        self.state = ''
        self.reading: Mapping[str, int] | None = None   # the last one
        self.lights = self._shown = b''     # commands that set the wanted lights, and those that were sent
        self._docked = False        # whether the last reading shows the dock
        self._since = 0             # when the state, or the last request to dock, began
        self._mode: int | None = None       # mode that the robot leaves when it starts to dock; None: unknown
        self._start: float | None = None    # m, position at the first reading after the order to undock

    def check(self) -> Mapping[str, int]:
        """Return the last reading, if the robot can follow orders. Raises RefusedCommand."""
        if self.sender.phase in (Phase.LEAVING, Phase.LEFT):
            raise RefusedCommand('the node is shutting down')
        if self.wanted == protocol.PASSIVE:
            raise RefusedCommand('operation_mode: 1: the robot is not driven in passive mode')
        if not (self.reading and self.contact.answers):
            raise RefusedCommand('the robot does not answer')
        return self.reading

    def send(self, now: int, data: bytes) -> None:
        """Send a command that does not move the robot. Raises RefusedCommand."""
        self.check()
        if not self.sender.may_send(Kind.PANEL):
            raise RefusedCommand(f"the robot is not driven: {self.supervisor.reason or 'it changes its mode'}")
        if self.sender.is_busy(now):
            raise RefusedCommand('the serial line is busy')
        self.sender.send(now, Kind.PANEL, data)

    def dock(self, now: int) -> None:
        """Let the robot find its dock. Raises RefusedCommand."""
        reading = self.check()
        reasons = causes(reading) or (['the robot is on its dock'] if reading['charging_sources'] & DOCK else [])
        if reasons:
            raise RefusedCommand(', '.join(reasons))
        self.end(now, 'a new order')
        self._mode = reading['mode'] if self.supervisor.in_control else None
        self._begin(now, DOCKING)
        self.supervisor.forget()
        self.supervisor.reason = DOCKING
        self._ask_to_dock(now)

    def _ask_to_dock(self, now: int) -> None:
        self._since = now
        # Start: a second cleaning command would pause the program of the first
        self.sender.stop(now, sequences.STOP + sequences.START + protocol.command('dock'), Kind.DOCK)
        self.sender.phase = Phase.DOCKING

    def undock(self, now: int) -> None:
        """Drive backward off the dock. Raises RefusedCommand."""
        reading = self.check()
        if causes(reading):
            raise RefusedCommand(', '.join(causes(reading)))
        if not reading['charging_sources'] & DOCK:
            raise RefusedCommand('the robot is not on its dock')
        self._begin(now, UNDOCKING)
        self.gate.command(now, -UNDOCK_SPEED, 0.0)
        self._start, self._docked = None, True
        self.supervisor.wanted, self.supervisor.attempt, self.supervisor.had_control = protocol.FULL, None, False

    def _begin(self, now: int, state: str) -> None:
        self.gate.halt()
        self.state, self._since = state, now
        self.info(f'The robot is {state}; a command on cmd_vel ends this')

    def end(self, now: int, reason: str) -> None:
        """Stop docking or undocking, if the robot does either. On its dock, it is left in passive mode and charges."""
        if not self.state:
            return
        self.warn(f'The robot is no longer {self.state}: {reason}')
        self._change_mode(now, protocol.PASSIVE if self._docked else self.wanted)
        self._finish()

    def _change_mode(self, now: int, mode: int) -> None:
        """Stop the robot, and change to a mode."""
        assert self.contact.found
        self.sender.stop(now, sequences.STOP + sequences.take_control(self.contact.found.model, mode), Kind.MODE)
        self.supervisor.wanted, self.supervisor.attempt, self.supervisor.asked = self.wanted, now, True

    def _finish(self) -> None:
        self.gate.halt()
        self.supervisor.forget()
        self.state, self.supervisor.wanted, self.supervisor.reason = '', self.wanted, ''

    def confirms_end(self) -> bool:
        """Return whether passive mode shows that the last stop has arrived. A robot that docks is in this mode, too: it
        is stopped and asked once more."""
        docked, self.state = self.state == DOCKING, ''
        return not docked

    def update(self, now: int, reading: Mapping[str, int], position: float) -> bool:
        """Process a reading, at which the wheels have traveled `position` (m). Returns whether the robot docks, so that
        the driver must leave it alone."""
        self.reading = reading
        before, self._docked = self._docked, bool(reading['charging_sources'] & DOCK)
        is_sure = before == self._docked    # one reading may be corrupted
        if self.state == DOCKING:
            self._follow_docking(now, reading, is_sure)
        elif self.state:
            self._drive_off(now, reading, is_sure, position)
        if self.sender.phase is not Phase.DRIVEN:
            self._shown = b''
        elif self._shown != self.lights:
            self._shown = self.lights
            self.sender.send(now, Kind.PANEL, self.lights)
        return self.state == DOCKING

    def _follow_docking(self, now: int, reading: Mapping[str, int], is_sure: bool) -> None:
        if self.sender.phase is not Phase.DOCKING:
            self.end(now, 'it did not answer')
        elif self._docked and is_sure:
            self._finish()
            self.info('The robot is on its dock')
        elif reading['mode'] == self._mode and now - self._since > RETRY:      # the order was lost
            self._ask_to_dock(now)

    def _drive_off(self, now: int, reading: Mapping[str, int], is_sure: bool, position: float) -> None:
        if causes(reading):
            self.end(now, ', '.join(causes(reading)))
        elif not self.gate.moving:
            self.end(now, 'it was stopped')
        elif now - self._since > UNDOCK_TIME:
            self.end(now, f'it has not driven {UNDOCK_DISTANCE} m in {UNDOCK_TIME // SECOND} s')
        else:
            self._start = position if self._start is None else self._start
            self.gate.command(now, -UNDOCK_SPEED, 0.0)
            if self.state == UNDOCKING and is_sure and not self._docked:
                self.state = BACKING
                self._change_mode(now, self.wanted)
            elif self.state == BACKING and self._start - position >= UNDOCK_DISTANCE:
                self.gate.halt()
                self.state = ''
                self.info('The robot has left its dock')
