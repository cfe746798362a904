"""A driver and an emulated robot on one clock, without a serial port, shared by the unit tests."""
import os

import pytest

from rbx1_nav.base.command_gate import CommandGate, RefusedCommand
from rbx1_nav.base.units import SECOND
from rbx1_nav.extras.create.create_parameters import read_settings
from rbx1_nav.extras.create.driver import Driver
from rbx1_nav.extras.create.emulator.body import Body
from rbx1_nav.extras.create.emulator.emulator import EmulatedCreate
from rbx1_nav.extras.create.emulator.serial_line import SerialLine
from rbx1_nav.extras.create.protocol import MODELS

SURFACES = os.path.join(os.path.dirname(__file__), '..', '..', '..', '..', 'config', 'surfaces')
STEP = SECOND // 500
BOTH = pytest.mark.parametrize('robot_type', ['create', 'create2'])
# parameters of the node: an ideal floor adds no error
NO_ERRORS = {'odom_linear_error': 0.0, 'odom_angular_error': 0.0, 'odom_heading_error': 0.0}


class DrivenCreate:
    """A driver and an emulated robot on a line whose cable can be unplugged."""

    is_same = True      # whether the line uses the same adapter as the previous line

    def __init__(self, robot_type, surface=None, seed=0, robot=None, mode_plus_one=False, drops_fractions=False,
                 **params):
        """robot_type: auto, create or create2; robot: the true type, if it differs; surface, seed, drops_fractions: see
        Body; mode_plus_one: see Model; params: parameters of the node."""
        self.settings, base = read_settings(dict(params, robot_type=robot_type))
        self.gate = CommandGate(base.limits, base.timeout)
        self.log = []
        self.errors = []        # log lines that are errors
        self.driver = Driver(self.settings, self.gate, self.log.append, self.log.append, self.log_error)
        self.now = SECOND
        model = MODELS[robot or robot_type]
        model = model._replace(mode_plus_one=model.mode_plus_one or mode_plus_one)
        self.body = Body(model, surface, seed, drops_fractions=drops_fractions)
        self.line = SerialLine(model.baud, seed)
        self.commands = []      # (time, bytes) that have arrived at the robot
        self.robot = EmulatedCreate(self.body, self.line, self.now,
                                    lambda time, data: self.commands.append((time, data)))
        self.connected = False
        self.states = []
        self.found = None       # the Model of the robot that the guardian may stop
        self.refusals = []      # texts
        self.velocity = None    # m/s and rad/s: command to repeat, or None
        self.rate = 50          # Hz, of the sender
        self.losing = 0         # number of bytes to the robot that the line loses next
        self.hangs_until = 0    # time until which the robot neither executes nor sends anything
        self.held = [], bytearray()     # writes and replies that wait until then

    def log_error(self, text):
        self.log.append(text)
        self.errors.append(text)

    def connect(self):
        self.connected = True
        self.driver.attach(self.now, self)

    # the interface of a Link for the driver

    def write(self, data):
        lost, self.losing = data[:self.losing], max(0, self.losing - len(data))
        if self.now < self.hangs_until:
            self.held[0].append(data[len(lost):])
        else:
            self.robot.receive(data[len(lost):], self.now)

    def write_apart(self, data):
        for byte in data:
            self.write(bytes((byte,)))

    def set_rate(self, baud):
        self.line.host_baud = baud

    def confirm(self, model):
        """Record the robot that the guardian may stop."""
        self.found = model

    def pull(self):
        """Unplug the cable. Bytes in transit are lost."""
        self.connected = False
        self.driver.detach()

    def run(self, seconds):
        """Run both, with a step of the driver every 2 ms."""
        end = self.now + round(seconds * SECOND)
        while self.now < end:
            self.now += STEP
            data = self.receive()
            if self.velocity and self.now % (SECOND // self.rate) < STEP:
                self.command(*self.velocity)
            if not self.connected:
                continue
            self.driver.receive(self.now, data)
            self.driver.tick(self.now)
            state = self.driver.state()
            if state:
                self.states.append(state)

    def hang(self, seconds):
        """Let the robot hang: its wheels turn, and bytes in both directions wait."""
        self.hangs_until = self.now + round(seconds * SECOND)

    def receive(self):
        """Return the bytes that arrive now."""
        writes, replies = self.held
        replies += self.robot.advance(self.now)
        if self.now < self.hangs_until:
            return b''
        for data in writes:
            self.robot.receive(data, self.now)
        data = bytes(replies)
        self.held = [], bytearray()
        return data

    def command(self, linear, angular, sender='driver'):
        """Send a command, and store the text if it is refused."""
        try:
            self.driver.command(self.now, linear, angular, sender=sender)
        except RefusedCommand as error:
            self.refusals.append(str(error))

    def stall(self, seconds):
        """Pause the computer: the robot continues, and the bytes that it sends wait."""
        self.now += round(seconds * SECOND)

    def drive(self, linear, angular, seconds):
        """Repeat a command for some seconds."""
        self.velocity = linear, angular
        self.run(seconds)
        self.velocity = None

    def command_zero(self):
        self.command(0, 0)

    @property
    def truth(self):
        """The true Pose of the robot."""
        return self.body.wheels.truth.pose

    @property
    def pose(self):
        """The Pose of the odometry."""
        return self.driver.motion.odometry.pose

    @property
    def speeds(self):
        """The wheel speeds of the robot, (left, right) in mm/s."""
        return self.body.left, self.body.right


def started(robot_type, seconds=2.0, **params):
    """Return a DrivenCreate after it has connected."""
    driven = DrivenCreate(robot_type, **params)
    driven.connect()
    driven.run(seconds)
    return driven
