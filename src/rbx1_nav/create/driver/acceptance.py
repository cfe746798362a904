"""Decides which commands a Create follows, and how fast its wheels may go. All times are in ns."""
from __future__ import annotations

from math import copysign
from typing import Mapping

from rbx1_nav.control.gate import CommandGate, RefusedCommand
from rbx1_nav.control.lockout import Lockout
from rbx1_nav.create import protocol
from rbx1_nav.create.driver.contact import Contact
from rbx1_nav.create.driver.parameters import Settings
from rbx1_nav.create.driver.speeds import wheel_speeds
from rbx1_nav.create.driver.supervisor import BUMPS, WHEEL_DROPS, Supervisor
from rbx1_nav.create.driver.travel import Expected, Travel
from rbx1_nav.units import SECOND

OUTAGE = 3 * SECOND // 10   # without the robot, or its obedience, that do no harm
BLOCKED = 0.1               # m that a wheel should have travelled, while none has turned
TURNED = 0.1                # of what they should have travelled: then they turn


class Acceptance:
    """What stands between a command and the wheels: the gate, senders that have not noticed a stop, the robot."""

    def __init__(self, settings: Settings, gate: CommandGate, contact: Contact, supervisor: Supervisor) -> None:
        self.settings = settings
        self.gate = gate
        self.contact = contact
        self.supervisor = supervisor
        self.lockout = Lockout(gate.timeout)
        self.reading_time: int | None = None    # when the robot made the last reading
        self._bits = self._felt = 0     # bumps and wheel drops: of the last reading, of the last two
        self._blocked = 0.0         # m, see BLOCKED
        self._ignored_since: int | None = None  # the first of the commands to move that the robot does not follow

    def feel(self, time: int, reading: Mapping[str, int]) -> bool:
        """A reading has arrived. Returns whether a wheel has dropped: in two readings, since one may be corrupted."""
        bits, self.reading_time = reading['bumps_and_wheel_drops'], time
        self._felt, self._bits = bits & self._bits, bits
        return bool(self._felt & WHEEL_DROPS)

    def follow(self, elapsed: float, expected: Expected, travel: Travel, width: float) -> None:
        """The wheels have made a Travel since the last reading, `elapsed` s ago. expected: by the commands, which
        prove nothing of a robot that was out of reach; width: m between the wheels."""
        by_commands = max(abs(each) for each in expected)
        turns = abs(travel.distance) + abs(travel.angle) * width / 2 > TURNED * by_commands
        self._blocked = 0.0 if turns or elapsed > OUTAGE / SECOND else self._blocked + by_commands

    def lose_robot(self) -> None:
        """The robot does not answer any more."""
        self.gate.halt()
        self._felt = 0

    def lock(self, reason: str) -> None:
        """Something has stopped the robot: see Lockout."""
        self.gate.halt()
        self._blocked = 0.0
        self.lockout.lock(reason)

    def check_sender(self, now: int, sender: str, moving: bool) -> None:
        """Raises RefusedCommand for a sender that has not noticed that the robot was stopped."""
        if self.lockout.refuses(now, sender, moving):
            raise RefusedCommand(f'{self.lockout.reason}; expected a zero command, or none for '
                                 f'{self.gate.timeout / SECOND:g} s, before it is driven again')

    def check_obedience(self, now: int) -> None:
        """Raises RefusedCommand if the robot does not follow the command in force, and will not in a moment."""
        if self._is_bumped(self._felt):
            raise RefusedCommand('a bumper is pressed')
        obstacle = self._obstacle(now)
        if obstacle:
            self.lock(obstacle)
            raise RefusedCommand(obstacle)

    def speeds(self, model: protocol.Model) -> tuple[float, float]:
        """(left, right) in mm/s that a robot of this Model may go now."""
        linear, angular = self.gate.linear, self.gate.angular
        if not self._is_obeyed or self._bits & WHEEL_DROPS or self._is_bumped(self._bits):
            return 0.0, 0.0
        if angular:
            angular = copysign(max(abs(angular), self.settings.min_yaw_speed), angular)
        return wheel_speeds(linear, angular, model.wheel_separation)

    @property
    def _is_obeyed(self) -> bool:
        return self.contact.answers and self.supervisor.in_control and self.settings.mode != protocol.PASSIVE

    def _is_bumped(self, bits: int) -> bool:
        return self.gate.linear > 0 and self.settings.stop_on_bump and bool(bits & BUMPS)

    def _obstacle(self, now: int) -> str:
        """Why the robot does not follow the command in force, and has not done so for a while; else ''."""
        if not self.gate.moving or self._is_obeyed:
            self._ignored_since = None
            if self.gate.moving and self._blocked > BLOCKED:
                return 'its wheels do not turn: expected wheels that are free, and oi_mode_workaround: auto'
            return ''
        if not self.contact.answers:
            lost = self.reading_time is None or now - self.reading_time > OUTAGE
            return 'the robot does not answer' if lost else ''
        self._ignored_since = self._ignored_since or now
        if now - self._ignored_since < OUTAGE:
            return ''
        if self.supervisor.in_control:
            return 'operation_mode: 1: the robot is not driven in passive mode'
        return f"the robot is not driven: {self.supervisor.reason or 'it does not change to the wanted mode'}"
