"""Simulated wheels: how they follow commands, and what their encoders count."""
from __future__ import annotations

from math import floor, hypot
from typing import Union

from rbx1_nav.base.covariances import MEASURED, OdometryErrors, Uncertainty
from rbx1_nav.base.kinematics import ORIGIN, Odometry
from rbx1_nav.simulation.floor import Floor
from rbx1_nav.simulation.motors import Delay, Motor


class Encoder:
    """Counts whole ticks, rounded to the nearest tick."""

    def __init__(self, ticks_meter: float) -> None:
        self.ticks_meter = ticks_meter
        self.total = 0.0    # m, total travel of the wheel
        self.ticks = 0

    def count(self, travel: float) -> float:
        """Return the travel (m) that is counted while the wheel travels `travel` (m)."""
        self.total += travel
        before, self.ticks = self.ticks, floor(self.total * self.ticks_meter + 0.5)
        return (self.ticks - before) / self.ticks_meter


class IdealWheels:
    """Wheels without inertia and slip, which follow every command immediately and exactly."""

    at_rest = True      # they stay at rest until there is a motion command
    uncertainty = Uncertainty(MEASURED, MEASURED, MEASURED, MEASURED)       # of the odometry
    speed_variances = uncertainty[2:]

    def __init__(self, base_width: float) -> None:
        """base_width: distance between the wheels, m."""
        self.base_width = base_width
        self.truth = Odometry(base_width)       # motion of the robot itself, which no encoder measures

    def velocity(self, linear: float, angular: float) -> tuple[float, float]:
        """Return the speeds that the encoders report while this command is in force, m/s and rad/s."""
        return linear, angular

    true_velocity = velocity        # of the robot itself

    def travel(self, linear: float, angular: float, duration: float) -> tuple[float, float]:
        """Return the (left, right) travel in m that the encoders count in `duration` (s).

        linear (m/s), angular (rad/s): the command in force during this time.
        """
        if not (linear or angular):     # a robot at rest needs no arithmetic
            return 0.0, 0.0
        difference = angular * self.base_width / 2
        left, right = (linear - difference) * duration, (linear + difference) * duration
        self.truth.update(left, right)
        return left, right

    def reset(self) -> None:
        """Put the robot back at the origin, at rest."""
        self.truth.pose = ORIGIN


class Wheels:
    """Two wheels with delay, inertia and drag on a floor, and encoders that count whole ticks.

    The two motors are identical, so their common motion (straight) and their opposite motion (turning) are independent.
    Each of these motions has its own drag.
    """

    def __init__(self, base_width: float, floor: Floor, window: float) -> None:
        """floor: in one run or in many; window: s, the time over which encoder counts are averaged to report a speed.
        """
        surface = floor.surface
        self.window = window
        self.base_width = base_width
        self.surface = surface
        self.floor = floor
        self.truth = floor.truth
        self.noise = OdometryErrors(surface.distance_noise, surface.heading_noise_turning,
                                    surface.heading_noise_straight)
        self.delay = Delay(surface.delay) if surface.delay else None
        self.straight = Motor(surface.lag, surface.accel_limit, surface.drag_straight)
        self.turning = Motor(surface.lag, surface.accel_limit, surface.drag_turning)
        self.left = Encoder(surface.ticks_meter)
        self.right = Encoder(surface.ticks_meter)
        wheel = (1 / surface.ticks_meter) ** 2 / 6 / window ** 2
        self.rounding = MEASURED + wheel / 2, MEASURED + 2 * wheel / base_width ** 2
        self.reset()

    def reset(self) -> None:
        """Put the robot back at the origin, at rest."""
        self.straight.speed = self.turning.speed = 0.0
        if self.delay:
            self.delay.clear()
        self._rolling = False       # whether anything moved in the last step
        self._velocity = 0.0, 0.0   # m/s, rad/s
        self._time = self._distance = self._angle = 0.0     # s, m and rad since the last velocity
        self._path = self._turned = 0.0     # m and rad, both directions counted positive
        self.truth.pose = ORIGIN

    def travel(self, linear: float, angular: float, duration: float) -> tuple[float, float]:
        """See IdealWheels."""
        if self.delay:
            straight = turning = 0.0
            for speed, rate, part in self.delay.over(linear, angular, duration):
                straight += self.straight.travel(speed, part)
                turning += self.turning.travel(rate * self.base_width / 2, part)
        else:
            straight = self.straight.travel(linear, duration)
            turning = self.turning.travel(angular * self.base_width / 2, duration)
        self._rolling = bool(straight or turning or self.straight.speed or self.turning.speed)
        self.floor.move(straight, 2 * turning / self.base_width)
        left, right = self.left.count(straight - turning), self.right.count(straight + turning)
        self._update_velocity(left, right, duration)
        return left, right

    def velocity(self, *_: float) -> tuple[float, float]:
        """Return the speeds from the encoders' latest counts, whatever is commanded."""
        return self._velocity

    def true_velocity(self, *_: float) -> tuple[float, float]:
        """Return the motors' speeds minus slip, whatever is commanded."""
        return self.floor.slipped(self.straight.speed, 2 * self.turning.speed / self.base_width)

    @property
    def at_rest(self) -> bool:
        """Whether nothing moved in the last step, and the reported speeds are 0."""
        return not (self._rolling or any(self._velocity) or (self.delay and not self.delay.is_empty))

    def _update_velocity(self, left: float, right: float, duration: float) -> None:
        self._distance += (left + right) / 2
        self._angle += (right - left) / self.base_width
        self._time += duration
        if self._time > 0.75 * self.window:     # steps differ slightly from their nominal length
            self._velocity = self._distance / self._time, self._angle / self._time
            self._path += abs(self._distance)
            self._turned += abs(self._angle)
            self._time = self._distance = self._angle = 0.0

    @property
    def uncertainty(self) -> Uncertainty:
        """The Uncertainty of the odometry.

        The variances of the pose come from the sum of all slip. This is an upper bound, because the return path may
        cancel slip.
        """
        surface = self.surface
        yaw = hypot(surface.slip_turning, surface.slip_turning_spread) * self._turned
        position = hypot(hypot(surface.slip_straight, surface.slip_straight_spread), yaw) * self._path
        tick = 1 / surface.ticks_meter
        length, heading = self.noise.variances(self._path, self._turned)
        position = position ** 2 + tick ** 2 + length + heading * self._path ** 2
        yaw = yaw ** 2 + (tick / self.base_width) ** 2 + heading
        return Uncertainty(position, yaw, *self.speed_variances)

    @property
    def speed_variances(self) -> tuple[float, float]:
        """The variances of the speeds that the encoders report, m^2/s^2 and rad^2/s^2.

        They come from the rounding to whole ticks over the window and from the floor's noise. The rounding has a
        variance of 1/6 tick^2, because it is the difference of two rounding errors (1/12 each). The speeds of a
        stationary robot are known.
        """
        if self.at_rest:
            return MEASURED, MEASURED
        length, heading = self.noise.variances(*self._velocity)
        linear, angular = self.rounding
        return linear + length / self.window, angular + heading / self.window


AnyWheels = Union[IdealWheels, Wheels]
