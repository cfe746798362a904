"""A simulated differential-drive base: the command gate, the wheels that follow the commands, odometry, and a gyro."""
from __future__ import annotations

from typing import Sequence

from rbx1_nav.base.command_gate import CommandGate
from rbx1_nav.base.covariances import Reading
from rbx1_nav.base.kinematics import ORIGIN, Odometry
from rbx1_nav.base.robot_parameters import Robot
from rbx1_nav.base.surfaces import Surface
from rbx1_nav.base.units import SECOND
from rbx1_nav.simulation.floor import Floor, make_floor
from rbx1_nav.simulation.gyro import AnyGyro, Gyro, IdealGyro
from rbx1_nav.simulation.wheels import AnyWheels, IdealWheels, Wheels

MAX_SPEED_WINDOW = 0.1  # s: the longest time over which encoder counts are averaged to report a speed


def make_base(robot: Robot, surface: Surface | None, seed: int, floor: Floor | None = None) -> SimulatedBase:
    """Return the SimulatedBase of a Robot on a Surface (None: ideal).

    seed: an integer that determines the random errors of the run; floor: in place of the seed's, for many runs, whose
    gyros are not simulated.
    """
    window = speed_window(robot)
    wheels, gyro = ((Wheels(robot.base_width, floor, window), IdealGyro()) if floor
                    else make_wheels_and_gyro(robot.base_width, surface, seed, window))
    return SimulatedBase(wheels, CommandGate(robot.limits, robot.timeout), gyro)


def speed_window(robot: Robot) -> float:
    """Return the time over which encoder counts are averaged to report a speed, s."""
    return min(1 / robot.rate, MAX_SPEED_WINDOW)


def make_wheels_and_gyro(base_width: float, surface: Surface | None, seed: int,
                         window: float) -> tuple[AnyWheels, AnyGyro]:
    """Return the wheels and the gyro of a robot.

    base_width: m; surface, seed: see make_base(); window: see Wheels.
    """
    if surface is None:
        return IdealWheels(base_width), IdealGyro()
    floor = make_floor(surface, seed)
    return Wheels(base_width, floor, window), Gyro(surface, floor.run, seed)


class SimulatedBase:
    """A base on a clock that the caller provides; all times are in ns.

    A command is in force from its arrival until the next command arrives or until it times out. The pose is the exact
    integral over these intervals, independent of the times at which it is read.
    """

    def __init__(self, wheels: AnyWheels, gate: CommandGate, gyro: AnyGyro) -> None:
        self.wheels = wheels
        self.gate = gate
        self.gyro = gyro
        self.odometry = Odometry(wheels.base_width)
        self.left = 0.0         # m, total travel that the left wheel's encoder counted
        self.right = 0.0        # m
        self.now = 0            # ns, up to which the motion is integrated
        self._gyro_time: int | None = None      # ns, time of the last reading

    @property
    def velocity(self) -> tuple[float, float]:
        """The speeds that the encoders report, m/s and rad/s."""
        return self.wheels.velocity(self.gate.linear, self.gate.angular)

    @property
    def true_velocity(self) -> tuple[float, float]:
        """The speeds of the robot itself, m/s and rad/s."""
        return self.wheels.true_velocity(self.gate.linear, self.gate.angular)

    @property
    def at_rest(self) -> bool:
        """Whether the robot is stationary and no command will change that."""
        return not self.gate.moving and self.wheels.at_rest

    def command(self, now: int, linear: float, angular: float, others: Sequence[float] = (), _sender: str = '') -> bool:
        """Put a command in force from `now` on; for arguments, result and errors see CommandGate.command()."""
        self.advance(now)
        return self.gate.command(now, linear, angular, others)

    def advance(self, now: int) -> bool:
        """Integrate the motion up to `now`, and return whether the command in force has timed out by then.

        If the clock jumped back, the command in force is dropped, because its age is no longer known.
        """
        if now == self.now:     # usual for a command: it arrives right after a tick
            return False
        gate = self.gate
        timed_out = False
        if now < self.now:
            gate.forget()
        elif gate.moving:
            expiry = gate.expiry
            self._move(min(now, expiry) - self.now)
            timed_out = now >= expiry
            if timed_out:
                gate.halt()
                self._roll_out(now - expiry)
        else:
            self._roll_out(now - self.now)
        self.now = now
        return timed_out

    def read_gyro(self) -> Reading | None:
        """Return the gyro's Reading since the last call, or None at the first call or if no time has passed."""
        last, self._gyro_time = self._gyro_time, self.now
        if last is None or self.now <= last:
            return None
        return self.gyro.read(self.wheels.truth.yaw, (self.now - last) / SECOND, self.at_rest)

    def change_floor(self, surface: Surface | None, seed: int, window: float) -> None:
        """Put the base on another floor; see make_wheels_and_gyro(). To be followed by reset()."""
        self.wheels, self.gyro = make_wheels_and_gyro(self.wheels.base_width, surface, seed, window)

    def reset(self) -> None:
        """Put the base back at the origin, at rest."""
        self.gate.halt()
        self.wheels.reset()
        self.gyro.reset()
        self.odometry.pose = ORIGIN

    def _roll_out(self, duration: float) -> None:
        if not self.wheels.at_rest:
            self._move(duration)

    def _move(self, duration: float) -> None:
        left, right = self.wheels.travel(self.gate.linear, self.gate.angular, duration / SECOND)
        self.left += left
        self.right += right
        self.odometry.update(left, right)
