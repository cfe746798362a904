"""Who controls the robot: it falls back to passive mode when a wheel drops, at a cliff, and at its charger."""
from rbx1_nav.create import protocol
from rbx1_nav.units import SECOND

HOLD = SECOND           # ns that the cause must be gone before the driver takes control again
RETRY = SECOND // 2     # ns between two attempts
CLIFFS = ('cliff_left', 'cliff_front_left', 'cliff_front_right', 'cliff_right')
WHEEL_DROPS = protocol.WHEEL_DROP_LEFT | protocol.WHEEL_DROP_RIGHT | protocol.WHEEL_DROP_CASTOR
BUMPS = protocol.BUMP_LEFT | protocol.BUMP_RIGHT
CHARGER, DOCK = 1, 2    # bits of packet 34


def causes(reading):
    """Why a robot with this reading gives up safe mode: a list of texts."""
    found = []
    if reading['bumps_and_wheel_drops'] & WHEEL_DROPS:
        found.append('a wheel dropped')
    if any(reading[name] for name in CLIFFS):
        found.append('a cliff')
    if reading['charging_sources'] & CHARGER:
        found.append('the charger is plugged in')
    return found


class Supervisor:
    """Decides when to ask the robot for the mode in which it is driven."""

    def __init__(self, mode, info, warn):
        """mode: the wanted one, of packet 35; info(text), warn(text): log a line."""
        self.wanted = mode
        self.info = info
        self.warn = warn
        self.mode = None            # of the last two readings
        self.reason = ''            # why the robot is not in the wanted mode
        self.had_control = False
        self.forget()

    @property
    def in_control(self):
        """Whether the robot is in the wanted mode."""
        return self.mode == self.wanted

    def forget(self):
        """There are no readings any more."""
        self.mode = self.latest = self.clear_since = self.attempt = None

    def update(self, now, reading, wants_motion):
        """Whether to ask for the wanted mode at `now` (ns). wants_motion: whether a command to move is in force."""
        mode, before = reading['mode'], self.latest
        self.latest = mode
        if mode != before:      # one reading may be corrupted, the second one counts
            return False
        self._note(mode)
        if self.in_control:
            self.clear_since = None
            return False
        found = causes(reading)
        docked = bool(reading['charging_sources'] & DOCK)
        self._explain(', '.join(found + ['on the dock: carry it off if a command does not move it'] * docked))
        if found or docked and not wants_motion:
            self.clear_since = None
            return False
        if self.clear_since is None:
            self.clear_since = now
        if now - self.clear_since < HOLD * self.had_control or (
                self.attempt is not None and now - self.attempt < RETRY):
            return False
        self.attempt = now
        return True

    def _note(self, mode):
        before, self.mode = self.mode, mode
        if mode == self.wanted and before != mode:
            self.had_control, self.reason = True, ''
            self.info('The robot is in %s mode' % protocol.MODE_NAMES[mode])
        elif before == self.wanted and mode != before:
            self.reason = None
            self.warn('The robot stopped: it changed from %s to %s mode' % (
                protocol.MODE_NAMES[before], protocol.MODE_NAMES[mode]))

    def _explain(self, reason):
        before, self.reason = self.reason, reason
        if reason and reason != before:
            self.warn('The robot is not driven: %s' % reason)
