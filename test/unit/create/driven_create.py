"""A driver and an emulated robot on one clock, without a serial port: what the unit tests share."""
import os

from rbx1_nav.control.gate import CommandGate
from rbx1_nav.create.body import Body
from rbx1_nav.create.driver import Driver
from rbx1_nav.create.emulator import EmulatedCreate
from rbx1_nav.create.parameters import read_settings
from rbx1_nav.create.serial_line import SerialLine
from rbx1_nav.units import SECOND

SURFACES = os.path.join(os.path.dirname(__file__), '..', '..', '..', 'config', 'surfaces')
STEP = SECOND // 500


class DrivenCreate:
    """Both ends of a line whose cable can be pulled."""

    def __init__(self, robot_type, surface=None, seed=0, **params):
        """robot_type: create or create2; surface, seed: of the Body; params: of the node."""
        self.settings, robot = read_settings(dict(params, robot_type=robot_type))
        self.gate = CommandGate(robot.limits, robot.timeout)
        self.log = []
        self.driver = Driver(self.settings, self.gate, self.log.append, self.log.append)
        self.now = SECOND
        self.body = Body(self.settings.model, surface, seed)
        self.line = SerialLine(self.settings.model.baud, seed)
        self.commands = []      # (time, bytes) that have arrived at the robot
        self.robot = EmulatedCreate(self.settings.model, self.body, self.line, self.now,
                                    lambda time, data: self.commands.append((time, data)))
        self.connected = False
        self.states = []
        self.velocity = None    # m/s and rad/s: the command that is repeated, or None

    def connect(self):
        """Put the cable in."""
        self.connected = True
        self.driver.attach(self.now, lambda data: self.robot.receive(data, self.now))

    def pull(self):
        """Pull the cable. What is on the way is lost."""
        self.connected = False
        self.driver.detach(self.now)

    def run(self, seconds):
        """Let both run, with a step of the driver every 2 ms."""
        end = self.now + round(seconds * SECOND)
        while self.now < end:
            self.now += STEP
            data = self.robot.advance(self.now)
            if self.velocity and self.now % (SECOND // 50) < STEP:
                self.driver.command(self.now, *self.velocity)
            if not self.connected:
                continue
            self.driver.receive(self.now, data)
            self.driver.tick(self.now)
            state = self.driver.state()
            if state:
                self.states.append(state)

    def drive(self, linear, angular, seconds):
        """Repeat a command for a while."""
        self.velocity = linear, angular
        self.run(seconds)
        self.velocity = None

    def command_zero(self):
        """Stop by a command."""
        self.driver.command(self.now, 0, 0)

    @property
    def truth(self):
        """The Pose of the robot itself."""
        return self.body.wheels.truth.pose

    @property
    def pose(self):
        """The Pose of the odometry."""
        return self.driver.motion.odometry.pose

    @property
    def speeds(self):
        """(left, right) in mm/s that the robot drives."""
        return self.body.left, self.body.right


def started(robot_type, seconds=2.0, **params):
    """A DrivenCreate after it has connected."""
    driven = DrivenCreate(robot_type, **params)
    driven.connect()
    driven.run(seconds)
    return driven
