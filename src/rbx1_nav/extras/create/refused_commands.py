"""Decides which commands a Create follows, and how fast its wheels may turn. All times are in ns."""
from __future__ import annotations

from math import copysign
from typing import Mapping

from rbx1_nav.base.command_gate import CommandGate, RefusedCommand
from rbx1_nav.base.covariances import Travel
from rbx1_nav.base.units import SECOND
from rbx1_nav.extras.create import protocol
from rbx1_nav.extras.create.connection import Supervisor
from rbx1_nav.extras.create.create_parameters import Settings
from rbx1_nav.extras.create.odometry import Expected
from rbx1_nav.extras.create.queries import Queries
from rbx1_nav.extras.create.sender import ANSWERING, Phase, Sender, wheel_speeds

MAX_SENDERS = 20    # senders that are stored before the silent ones are removed
OUTAGE = 3 * SECOND // 10   # longest harmless time in which the robot does not answer or obey
TOO_BAD = 0.5               # share of lost replies at which the robot is stopped
BLOCKED = 0.1               # m, commanded travel of a wheel without a turn of any wheel
TURNED = 0.1                # fraction of the commanded travel from which the wheels count as turning
AT_CLIFF = 1 << 8       # a bit that bumps and wheel drops do not use
BACK_UP = 'a cliff: expected a command that backs up'


class Acceptance:
    """The checks between a command and the wheels: the gate, senders unaware of a stop, the state of the robot."""

    def __init__(self, settings: Settings, gate: CommandGate, sender: Sender, queries: Queries,
                 supervisor: Supervisor) -> None:
        self.settings = settings
        self.gate = gate
        self.sender = sender
        self.queries = queries
        self.supervisor = supervisor
        # after an event, a sender is refused until it has sent a zero command, or nothing for the timeout of a command
        self._reason = ''       # of the last event
        self._released: set[str] | None = None      # senders whose commands are accepted; None for all senders
        self._latest: dict[str, int] = {}   # arrival time of the last command, by sender
        self._ran: int | None = None    # time at which the driver last ran
        # bumps, wheel drops and AT_CLIFF: in the last reading, and in both of the last two readings
        self._bits = self._felt = 0
        self._blocked = 0.0         # m, see BLOCKED
        self._bumped_since: int | None = None   # time of the first forward command while a bumper is pressed
        self._ignored_since: int | None = None  # time of the first motion command that the robot does not follow

    def feel(self, reading: Mapping[str, int]) -> bool:
        """Process a reading. Returns whether two readings show a dropped wheel, since one may be corrupted."""
        bits = reading['bumps_and_wheel_drops'] | (AT_CLIFF if any(reading[name] for name in protocol.CLIFFS) else 0)
        self._felt, self._bits = bits & self._bits, bits
        return bool(self._felt & protocol.WHEEL_DROPS)

    def follow(self, elapsed: float, expected: Expected, travel: Travel, width: float) -> None:
        """Check a Travel of the wheels since the last reading, `elapsed` s ago. expected: commanded travel, which is
        ignored after an outage; width: m between the wheels."""
        by_commands = max(abs(each) for each in expected)
        turns = abs(travel.distance) + abs(travel.angle) * width / 2 > TURNED * by_commands
        self._blocked = 0.0 if turns or elapsed > OUTAGE / SECOND else self._blocked + by_commands

    def lock(self, reason: str, unobserved: int = 0) -> None:
        """Halt, because something has stopped the robot, and lock out all senders that have not noticed it.

        unobserved: time until now in which no command could be received, which does not count as silence.
        """
        self.gate.halt()
        self._blocked = 0.0
        self._reason, self._released = reason, set()
        self._latest = {name: time + unobserved for name, time in self._latest.items()}

    def notice_stall(self, now: int) -> None:
        """Lock if the driver did not run for so long that a command would have expired: the commands that arrive now
        may have been sent any time before. Call it whenever the driver runs, before anything else."""
        stall, self._ran = now - (self._ran or now), now
        if stall >= max(self.gate.timeout, OUTAGE):
            self.lock(f'this node did not run for {stall / SECOND:.1f} s', stall)

    def notice_losses(self) -> None:
        """Lock if the robot is driven on a line that loses too large a share of the last replies."""
        share = self.queries.lost_share
        if self.gate.moving and share > TOO_BAD:
            self.lock(f'{100 * share:.0f} % of the replies of the robot are lost or corrupted')

    def check_sender(self, now: int, sender: str, moving: bool) -> None:
        """Raise RefusedCommand for a sender that has not noticed that the robot was stopped. moving: whether the
        command moves it."""
        silence, last = self.gate.timeout, self._latest.get(sender)
        self._latest[sender] = now
        if len(self._latest) > MAX_SENDERS:
            self._latest = {name: time for name, time in self._latest.items() if now - time <= silence}
        if self._released is None or sender in self._released:
            return
        if moving and last is not None and now - last <= silence:
            raise RefusedCommand(f'{self._reason}; expected a zero command, or none for {silence / SECOND:g} s, before '
                                 'it is driven again')
        self._released.add(sender)

    def check_obedience(self, now: int) -> None:
        """Raise RefusedCommand if the robot does not follow the command in force, and will not do so shortly."""
        self._bumped_since = (self._bumped_since or now) if self._is_obeyed and self._is_bumped(self._felt) else None
        if self._bumped_since is not None and now - self._bumped_since >= OUTAGE:   # a script may turn at a bump
            raise RefusedCommand('a bumper is pressed')
        if self._is_obeyed and self._is_at_edge(self._felt):
            raise RefusedCommand(BACK_UP)
        obstacle = self._obstacle(now)
        if obstacle:
            self.lock(obstacle)
            raise RefusedCommand(obstacle)

    def speeds(self, model: protocol.Model) -> tuple[float, float]:
        """Return the wheel speeds (left, right; mm/s) that a robot of this Model may have now."""
        linear, angular = self.gate.linear, self.gate.angular
        bits = self._bits
        if not self._is_obeyed or bits & protocol.WHEEL_DROPS or self._is_bumped(bits) or self._is_at_edge(bits):
            return 0.0, 0.0
        if angular:
            angular = copysign(max(abs(angular), self.settings.min_abs_yaw_vel), angular)
        return wheel_speeds(linear, angular, model.wheel_separation)

    @property
    def _is_obeyed(self) -> bool:
        return self.sender.phase is Phase.DRIVEN

    @property
    def backs(self) -> bool:
        """Whether the command in force is one that a robot in safe mode follows at a cliff: backward, in a curve with a
        radius larger than the robot's (Create p. 6)."""
        return self.gate.linear < 0 and -self.gate.linear >= abs(self.gate.angular) * protocol.ROBOT_RADIUS

    def _is_at_edge(self, bits: int) -> bool:
        return (bool(bits & AT_CLIFF) and self.settings.operation_mode == protocol.SAFE and self.gate.moving
                and not self.backs)

    def _is_bumped(self, bits: int) -> bool:
        return self.gate.linear > 0 and self.settings.stop_motors_on_bump and bool(bits & protocol.BUMPS)

    def _obstacle(self, now: int) -> str:
        """Return why the robot has not followed the command in force for some time; else ''."""
        if not self.gate.moving or self._is_obeyed:
            self._ignored_since = None
            if self.gate.moving and self._blocked > BLOCKED:
                return 'its wheels do not turn: expected wheels that can turn freely'
            return ''
        if self.sender.phase not in ANSWERING:
            heard = self.queries.heard
            return 'the robot does not answer' if heard is None or now - heard > OUTAGE else ''
        self._ignored_since = self._ignored_since or now
        if now - self._ignored_since < OUTAGE:
            return ''
        if self.supervisor.in_control:
            return 'operation_mode: 1: the robot is not driven in passive mode'
        if self._is_at_edge(self._felt):
            return BACK_UP
        return f"the robot cannot be driven: {self.supervisor.reason or 'it does not change to the requested mode'}"
