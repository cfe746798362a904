"""Keeps control of the robot, which falls back to passive mode when a wheel drops, at a cliff, and at its charger."""
from __future__ import annotations

from typing import Callable, Mapping

from rbx1_nav.create import protocol
from rbx1_nav.units import SECOND

HOLD = SECOND           # ns without the cause before the driver takes control again
RETRY = SECOND // 2     # ns between two attempts
SETTLE = SECOND // 10   # ns after which a reading shows the effect of a Start
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
    """Decides which mode to request, and when.

    Some Roombas report their mode plus one (create_robot, issue 64). Start puts a robot into passive mode, so what it
    reports after Start shows this offset. Only then is the mode requested in which the robot is driven.
    """

    def __init__(self, mode: int, plus_one: bool | None, info: Callable[[str], None],
                 warn: Callable[[str], None]) -> None:
        """mode: wanted value of packet 35; plus_one: whether the robot reports its mode plus one, None to detect it;
        info(text), warn(text): log a line."""
        self.wanted = mode
        self.plus_one = plus_one
        self.info = info
        self.warn = warn
        self.mode: int | None = None    # mode in the last two readings
        self.reason = ''            # why the robot is not in the wanted mode
        self.had_control = False
        self.offset = int(plus_one or False)        # of the reported mode
        self.observed = plus_one is not None        # whether the offset is known
        self.offset_logged = False
        self.forget()

    @property
    def in_control(self) -> bool:
        """Whether the robot is in the wanted mode."""
        return self.mode == self.wanted

    def forget(self) -> None:
        """Handle a robot that sends no more readings."""
        self.mode = None
        self.latest: int | None = None          # mode in the last reading
        self.clear_since: int | None = None     # ns, since when nothing prevents the robot from being driven
        self.attempt: int | None = None         # ns, time of the last request
        self.failures = 0           # consecutive requests that failed without a known cause

    def restart(self, now: int) -> None:
        """Handle a Start that is sent to a robot, which may be a different robot."""
        self.forget()
        self.had_control = False
        if self.plus_one is None:
            self.observed, self.attempt = False, now

    def is_passive(self, reading: Mapping[str, int]) -> bool:
        """Return whether a robot from which passive mode was requested may be in passive mode."""
        return reading['mode'] - protocol.PASSIVE in ((self.offset,) if self.observed else (0, 1))

    def update(self, now: int, reading: Mapping[str, int], wants_motion: bool, backs: bool = False) -> int | None:
        """Return the mode to request at `now` (ns), or None. wants_motion: whether a motion command is in force; backs:
        whether it is one that a robot in safe mode follows at a cliff.
        """
        reported, before = reading['mode'], self.latest
        self.latest = reported
        if reported != before:      # one reading may be corrupted, so the second one counts
            return None
        if not self.observed:
            self._observe(now, reported)
        if self.observed:
            self._note(min(reported - self.offset, protocol.FULL))
        if self.in_control:
            self.clear_since, self.failures = None, 0
            return None
        found = causes(reading)
        docked = bool(reading['charging_sources'] & DOCK)
        if found or docked:
            self.failures = 0
        reasons = list(found)
        if docked:
            reasons.append('on the dock: lift it off if it does not follow a command')
        if self.failures > ATTEMPTS_BEFORE_LOG:
            reasons.append(self._contradiction(reported))
        self._explain(', '.join(reasons))
        leaves_cliff = backs and found == [CLIFF]
        if (found and not leaves_cliff) or (docked and not wants_motion):
            self.clear_since = None
            return None
        if self.clear_since is None:
            self.clear_since = now
        if (self.had_control and now - self.clear_since < HOLD and not leaves_cliff) or (
                self.attempt is not None and now - self.attempt < RETRY):
            return None
        if self.attempt is not None and self.failures > ATTEMPTS_BEFORE_LOG:
            self.observed = self.plus_one is not None       # a Start may have been lost
        self.attempt = now
        self.failures += 1
        return self.wanted if self.observed else protocol.PASSIVE

    def _observe(self, now: int, reported: int) -> None:
        """Determine the offset if the last request, a Start, has had its effect."""
        if self.attempt is None or now - self.attempt < SETTLE or reported - protocol.PASSIVE not in (0, 1):
            return
        self.offset, self.observed, self.attempt = reported - protocol.PASSIVE, True, None
        if self.offset and not self.offset_logged:
            self.offset_logged = True
            self.warn('The robot reports its mode plus one: expected a mode from 0 to 3; corrected, as with '
                      'oi_mode_workaround:=true')

    def _contradiction(self, reported: int) -> str:
        """Return the reason for a robot that seems to disobey without a cause. reported: the reported mode."""
        workaround = '' if self.plus_one is None else (
            f' with oi_mode_workaround:={str(self.plus_one).lower()}; without this parameter the base detects it')
        return (f'it reports mode {reported} after it was asked for {protocol.MODE_NAMES[self.wanted]} mode: expected '
                f'{self.wanted + self.offset}{workaround}')

    def _note(self, mode: int) -> None:
        before, self.mode = self.mode, mode
        if mode == self.wanted and before != mode:
            self.had_control, self.reason = True, ''
            self.info(f'The robot is in {protocol.MODE_NAMES[mode]} mode')
        elif before == self.wanted and mode != before:
            self.reason = ''
            self.warn(f'Lost control of the robot: it changed from {protocol.MODE_NAMES[self.wanted]} to '
                      f'{protocol.MODE_NAMES[mode]} mode')

    def _explain(self, reason: str) -> None:
        before, self.reason = self.reason, reason
        if reason and reason != before:
            self.warn(f'The robot cannot be driven: {reason}')
