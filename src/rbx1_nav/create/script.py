"""The events that a script of the Create can wait for."""
from rbx1_nav.create.protocol import PASSIVE

BUMPS = 'bumps_and_wheel_drops'


def _bits(mask, *names):
    """Whether a bit is set in a packet."""
    return lambda values: any(values[name] & mask for name in names)


# by their numbers, from 1 on (Create p. 16)
EVENTS = (
    _bits(28, BUMPS), _bits(16, BUMPS), _bits(8, BUMPS), _bits(4, BUMPS),           # wheel drops: any, front, left, right
    _bits(3, BUMPS), _bits(2, BUMPS), _bits(1, BUMPS),                              # bumps: any, left, right
    _bits(1, 'virtual_wall'), _bits(1, 'wall'),
    _bits(1, 'cliff_left', 'cliff_front_left', 'cliff_front_right', 'cliff_right'),
    _bits(1, 'cliff_left'), _bits(1, 'cliff_front_left'), _bits(1, 'cliff_front_right'), _bits(1, 'cliff_right'),
    _bits(2, 'charging_sources'),                                                   # home base
    _bits(4, 'buttons'), _bits(1, 'buttons'),                                       # advance, play
    _bits(1, 'digital_inputs'), _bits(2, 'digital_inputs'), _bits(4, 'digital_inputs'), _bits(8, 'digital_inputs'),
    lambda values: values['mode'] == PASSIVE)


def event(byte):
    """The condition that a data byte of Wait Event stands for: a function of the packets' values by name.

    A negative number is the inverse of an event. None for a number without a meaning.
    """
    number = byte - 256 if byte > 127 else byte
    if not 1 <= abs(number) <= len(EVENTS):
        return None
    happens = EVENTS[abs(number) - 1]
    return happens if number > 0 else lambda values: not happens(values)
