"""Keeps control of the robot, which falls back to passive mode when a wheel drops, at a cliff, and at its charger."""
from __future__ import annotations

from typing import Callable, Mapping

from rbx1_nav.create import protocol
from rbx1_nav.units import SECOND

HOLD = SECOND           # ns without the cause before the driver takes control again
RETRY = SECOND // 2     # ns between two attempts
ATTEMPTS_BEFORE_LOG = 3            # number of attempts that fail without a known cause before the failure is logged
CLIFFS = ('cliff_left', 'cliff_front_left', 'cliff_front_right', 'cliff_right')
WHEEL_DROPS = protocol.WHEEL_DROP_LEFT | protocol.WHEEL_DROP_RIGHT | protocol.WHEEL_DROP_CASTOR
BUMPS = protocol.BUMP_LEFT | protocol.BUMP_RIGHT
CLIFF = 'a cliff'       # the only cause that a command can remove
CHARGER, DOCK = 1, 2    # bits of packet 34


def causes(reading: Mapping[str, int]) -> list[str]:
    """Return the reasons why a robot with this reading leaves safe mode."""
    found = []
    if reading['bumps_and_wheel_drops'] & WHEEL_DROPS:
        found.append('a wheel dropped')
    if any(reading[name] for name in CLIFFS):
        found.append(CLIFF)
    if reading['charging_sources'] & CHARGER:
        found.append('the charger is plugged in')
    return found


class Supervisor:
    """Decides which mode to request, and when. A robot that reports its mode plus one may seem to be in the wanted mode
    before it was requested, so the mode counts only afterwards."""

    def __init__(self, mode: int, plus_one: bool, info: Callable[[str], None], warn: Callable[[str], None]) -> None:
        """mode: wanted value of packet 35; plus_one: whether the robot reports its mode plus one (create_robot, issue
        64); info(text), warn(text): log a line."""
        self.wanted = mode
        self.plus_one = plus_one
        self.info = info
        self.warn = warn
        self.reason = ''            # why the robot is not in the wanted mode
        self.restart()

    @property
    def in_control(self) -> bool:
        """Whether the robot is in the wanted mode."""
        return self.mode == self.wanted

    def forget(self) -> None:
        """Handle a robot that sends no more readings."""
        self.mode: int | None = None            # mode in the last two readings
        self.latest: int | None = None          # mode in the last reading
        self.clear_since: int | None = None     # ns, since when nothing prevents the robot from being driven
        self.attempt: int | None = None         # ns, time of the last request
        self.failures = 0           # consecutive requests that failed without a known cause

    def restart(self) -> None:
        """Handle a Start that is sent to the robot."""
        self.forget()
        self.asked = self.had_control = False       # whether the mode was requested and reached since then

    def is_passive(self, reading: Mapping[str, int]) -> bool:
        """Return whether a robot is in passive mode."""
        return reading['mode'] - self.plus_one == protocol.PASSIVE

    def update(self, now: int, reading: Mapping[str, int], wants_motion: bool, backs: bool = False) -> int | None:
        """Return the mode to request at `now` (ns), or None. wants_motion: whether a motion command is in force; backs:
        whether it is one that a robot in safe mode follows at a cliff.
        """
        reported, before = reading['mode'], self.latest
        self.latest = reported
        if reported != before:      # one reading may be corrupted, so the second one counts
            return None
        if self.asked:
            self._note(min(reported - self.plus_one, protocol.FULL))
        if self.in_control:
            self.clear_since, self.failures = None, 0
            return None
        found, docked = causes(reading), bool(reading['charging_sources'] & DOCK)
        reasons = list(found)
        if docked:
            reasons.append('on the dock: lift it off if it does not follow a command')
        if reasons:
            self.failures = 0
        elif self.failures > ATTEMPTS_BEFORE_LOG:
            reasons.append(f'it reports mode {reported} after it was asked for {protocol.MODE_NAMES[self.wanted]} '
                           f'mode: expected {self.wanted + self.plus_one}, or oi_mode_workaround:='
                           f'{str(not self.plus_one).lower()}')
        explained, self.reason = self.reason, ', '.join(reasons)
        if self.reason not in ('', explained):
            self.warn(f'The robot cannot be driven: {self.reason}')
        leaves_cliff = backs and found == [CLIFF]
        if (found and not leaves_cliff) or (docked and not wants_motion):
            self.clear_since = None
            return None
        if self.clear_since is None:
            self.clear_since = now
        if (self.had_control and now - self.clear_since < HOLD and not leaves_cliff) or (
                self.attempt is not None and now - self.attempt < RETRY):
            return None
        self.attempt, self.asked = now, True
        self.failures += 1
        return self.wanted

    def _note(self, mode: int) -> None:
        before, self.mode = self.mode, mode
        if mode == self.wanted and before != mode:
            self.had_control, self.reason = True, ''
            self.info(f'The robot is in {protocol.MODE_NAMES[mode]} mode')
        elif before == self.wanted and mode != before:
            self.reason = ''
            self.warn(f'Lost control of the robot: it changed from {protocol.MODE_NAMES[self.wanted]} to '
                      f'{protocol.MODE_NAMES[mode]} mode')
