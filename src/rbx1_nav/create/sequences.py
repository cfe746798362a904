"""The sequences of bytes that the driver and its guardian send."""
from rbx1_nav.create import protocol
from rbx1_nav.create.protocol import command

# bumps, wheel drops and cliffs; charging state to capacity; then single packets
_NUMBERS = (1, 3, 34, 35)
STREAMED = _NUMBERS + (43, 44)      # of the Create 2
QUERIED = _NUMBERS + (19, 20, 33)   # of the Create: sending 19 and 20 sets them to 0
QUERY = command('query_list', len(QUERIED), *QUERIED)
START_STREAM = command('stream', len(STREAMED), *STREAMED)
RESUME_STREAM = command('pause_resume_stream', 1)
MODES = {protocol.PASSIVE: command('start'), protocol.SAFE: command('safe'), protocol.FULL: command('full')}

# What was sent last may be the beginning of any command of ours. Zeros complete it: no data of a command is a motion of
# more than a moment, and 0 is no command.
_PADDING = bytes(max(len(QUERY), len(START_STREAM)) - 1)
STOP = _PADDING + protocol.drive_direct(0, 0)


def ask(model):
    """Asks a robot that is on for a reading: the only one of a Create, the next ones of a Create 2."""
    return QUERY if model is protocol.CREATE else RESUME_STREAM


def start(model):
    """Starts the interface of a robot that was switched off, and asks for a reading. It leads to passive mode."""
    return STOP + command('start') + (QUERY if model is protocol.CREATE else START_STREAM)


def take_control(model, mode):
    """Changes to a mode. On the TurtleBot, digital output 0 of a Create switches the power of the sensors."""
    outputs = model is protocol.CREATE and mode != protocol.PASSIVE
    return MODES[mode] + (command('digital_outputs', 1) if outputs else b'')


def leave(model):
    """Stops the robot after any beginning of a command, and leaves it in passive mode, where it can be charged."""
    rest = command('digital_outputs', 0) if model is protocol.CREATE else command('pause_resume_stream', 0)
    return STOP + rest + command('start')
