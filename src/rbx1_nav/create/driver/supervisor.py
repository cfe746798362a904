"""Keeps control of the robot, which falls back to passive mode when a wheel drops, at a cliff, and at its charger."""
from __future__ import annotations

from typing import Callable, Mapping

from rbx1_nav.create import protocol
from rbx1_nav.units import SECOND

HOLD = SECOND           # ns without the cause before the driver takes control again
RETRY = SECOND // 2     # ns between two attempts
SETTLE = SECOND // 10   # ns after which a reading shows the requested mode
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


class Offset:
    """The offset of the reported mode: Roombas with Wi-Fi report their mode plus one (create_robot, issue 64)."""

    def __init__(self, wanted: int, value: int | None = None) -> None:
        """wanted: the mode that is requested; value: 0 or 1, or None to detect it."""
        self.wanted = wanted
        self.value = value
        self._reported: set[int | None] = set()     # modes reported so far
        self._attempts = 0

    def ask(self, reported: int) -> None:
        """Record that the wanted mode is requested. reported: the mode reported before."""
        self._reported.add(reported)
        self._attempts += 1

    def judge(self, reported: int, obstructed: bool) -> None:
        """Determine the offset from the mode that is reported after the request. obstructed: whether the robot has had
        a reason not to leave passive mode."""
        self._reported.add(reported)
        if reported == self.wanted + 1:
            self.value = 1
        elif reported == self.wanted == protocol.SAFE:
            # passive mode plus one looks the same, but it is also reported before the request
            if not obstructed and (protocol.PASSIVE in self._reported or self._attempts >= 2):
                self.value = 0
        elif reported in (self.wanted, protocol.PASSIVE):
            self.value = 0


class Supervisor:
    """Decides when to request the mode in which the robot is driven."""

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
        self.offset_logged = False
        self.restart()

    @property
    def in_control(self) -> bool:
        """Whether the robot is in the wanted mode."""
        return self.mode == self.wanted

    def restart(self) -> None:
        """Handle a start of the robot, which may be a different robot."""
        self.offset = Offset(self.wanted, None if self.plus_one is None else int(self.plus_one))
        self.forget()

    def forget(self) -> None:
        """Handle a robot that sends no more readings."""
        self.mode = None
        self.latest: int | None = None          # mode in the last reading
        self.clear_since: int | None = None     # ns, since when nothing prevents the robot from being driven
        self.attempt: int | None = None         # ns, time of the last attempt
        self.obstructed = False     # since the last attempt
        self.failures = 0           # consecutive attempts that failed without a known cause

    def is_passive(self, reading: Mapping[str, int]) -> bool:
        """Return whether a robot from which passive mode was requested may be in passive mode."""
        offsets = (0, 1) if self.offset.value is None else (self.offset.value,)
        return reading['mode'] - protocol.PASSIVE in offsets

    def update(self, now: int, reading: Mapping[str, int], wants_motion: bool, backs: bool = False) -> bool:
        """Return whether to request the wanted mode at `now` (ns). wants_motion: whether a motion command is in force;
        backs: whether it is one that a robot in safe mode follows at a cliff.
        """
        reported, before = reading['mode'], self.latest
        self.latest = reported
        if reported != before:      # one reading may be corrupted, so the second one counts
            return False
        found = causes(reading)
        docked = bool(reading['charging_sources'] & DOCK)
        obstructed = bool(found or docked)
        self.obstructed |= obstructed
        if self.offset.value is None:
            if self.attempt is None:        # request it once, whatever mode is reported
                return self._ask(now, reported, obstructed)
            if now - self.attempt < SETTLE:
                return False
            self.offset.judge(reported, self.obstructed)
            if self.offset.value and not self.offset_logged:
                self.offset_logged = True
                self.warn('The robot reports its mode plus one: expected a mode from 0 to 3; corrected, as with '
                          'oi_mode_workaround:=true')
        self._note(protocol.PASSIVE if self.offset.value is None else min(reported - self.offset.value, protocol.FULL))
        if self.in_control:
            self.clear_since, self.failures = None, 0
            return False
        if obstructed:
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
            return False
        if self.clear_since is None:
            self.clear_since = now
        if (self.had_control and now - self.clear_since < HOLD and not leaves_cliff) or (
                self.attempt is not None and now - self.attempt < RETRY):
            return False
        return self._ask(now, reported, obstructed)

    def _ask(self, now: int, reported: int, obstructed: bool) -> bool:
        self.attempt, self.obstructed = now, obstructed
        if not obstructed:
            self.failures += 1
        self.offset.ask(reported)
        return True

    def _contradiction(self, reported: int) -> str:
        """Return the reason for a robot that seems to disobey without a cause. reported: the reported mode."""
        workaround = '' if self.plus_one is None else (
            f' with oi_mode_workaround:={str(self.plus_one).lower()}; without this parameter the base detects it')
        return (f'it reports mode {reported} after it was asked for {protocol.MODE_NAMES[self.wanted]} mode: expected '
                f'{self.wanted + (self.offset.value or 0)}{workaround}')

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
