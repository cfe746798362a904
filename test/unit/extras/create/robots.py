"""An emulated robot for the unit tests."""
import pytest

from rbx1_nav.base.units import SECOND
from rbx1_nav.extras.create.emulator.body import Body, BodyErrors
from rbx1_nav.extras.create.emulator.emulator import EmulatedCreate
from rbx1_nav.extras.create.emulator.serial_line import SerialLine
from rbx1_nav.extras.create.protocol import (
    CREATE, CREATE_2, FULL, OFF, PASSIVE, SAFE, command, packets_format, single_packets)

# commands from off to each mode
ENTER = {OFF: b'', PASSIVE: command('start'), SAFE: command('start') + command('safe'),
         FULL: command('start') + command('full')}
BOTH_MODELS = CREATE, CREATE_2      # those that have a document
both = pytest.mark.parametrize('model', BOTH_MODELS, ids=lambda model: model.name)


class Robot:
    """An EmulatedCreate with a host that reads everything that the robot sends."""

    def __init__(self, model, surface=None, errors=BodyErrors(), baud=None, **options):
        self.body = Body(model, surface, 1, errors, **options)
        self.model = model
        self.commands = []
        self.now = 0
        self.robot = EmulatedCreate(self.body, SerialLine(baud or model.baud), 0,
                                    lambda time, data: self.commands.append((time, data)))

    def run(self, seconds):
        """Advance the time. Returns the bytes that have arrived at the host."""
        self.now += round(seconds * SECOND)
        return self.robot.advance(self.now)

    def send(self, *commands):
        """Send commands, and wait until they have been executed. Returns the bytes that have arrived by then."""
        self.robot.receive(b''.join(commands), self.now)
        return self.run(0.05)

    def read(self, number):
        """Return the values of a packet or group, by packet name."""
        packets = single_packets(self.model, [number])
        data = self.send(command('sensors', number))
        return dict(zip((packet.name for packet in packets), packets_format(packets).unpack(data)))

    @property
    def mode(self):
        return self.robot.mode

    @property
    def pose(self):
        """The true pose of the robot."""
        return self.body.wheels.truth.pose


def robot_in(mode, model, **options):
    """Return a Robot of this Model in a mode."""
    robot = Robot(model, **options)
    robot.send(ENTER[mode])
    assert robot.mode == mode
    return robot
