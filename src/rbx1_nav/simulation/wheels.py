"""Wheels: how they follow a command, what their encoders count, and where they take the robot.

All wheels have

    travel(linear, angular, duration)   the travel (left, right) that the encoders count, m, while a command is in force
    velocity(linear, angular)           the speeds that the encoders report meanwhile, m/s and rad/s
    true_velocity(linear, angular)      the speeds of the robot itself
    at_rest         whether they stand still, and will until there is a command to move
    truth           Odometry of the robot itself, which no encoder knows
    uncertainty     Uncertainty of the odometry
    reset()         puts the robot back at the origin, at rest
"""
from collections import deque
from math import copysign, exp, floor, hypot, log

from rbx1_nav.robot.kinematics import ORIGIN, Odometry
from rbx1_nav.robot.readings import MEASURED, Uncertainty


class IdealWheels:
    """Wheels that follow every command at once and exactly: no inertia, no slip."""

    at_rest = True
    uncertainty = Uncertainty(MEASURED, MEASURED, MEASURED, MEASURED)

    def __init__(self, base_width):
        """base_width: distance between the wheels, m."""
        self.base_width = base_width
        self.truth = Odometry(base_width)

    @staticmethod
    def velocity(linear, angular):
        """The commanded speeds."""
        return linear, angular

    true_velocity = velocity

    def travel(self, linear, angular, duration):
        """(left, right) travel in m while `linear` (m/s) and `angular` (rad/s) are in force for `duration` (s)."""
        difference = angular * self.base_width / 2
        left, right = (linear - difference) * duration, (linear + difference) * duration
        self.truth.update(left, right)
        return left, right

    def reset(self):
        """Put the robot back at the origin."""
        self.truth.pose = ORIGIN


class Motor:
    """A speed that follows a command with a lag and a limited acceleration, and stays below it because of drag.

    The acceleration is (command - speed -+ drag) / lag, limited to accel_limit. Drag always acts against the motion: it
    slows the start, shortens the stop, and holds a standing wheel while the command does not exceed it. Solved in
    closed form, so the result does not depend on the number of steps.
    """

    def __init__(self, lag, accel_limit, drag):
        """lag: s, accel_limit: m/s^2, drag: m/s; all above 0."""
        self.lag = lag
        self.accel_limit = accel_limit
        self.drag = drag
        self.speed = 0.0        # m/s

    def travel(self, command, duration):
        """The travel (m) while a speed (m/s) is commanded for `duration` (s)."""
        travel = 0.0
        while duration > 0:
            target = command - copysign(self.drag, self.speed or command)
            if not self.speed and target * command <= 0:
                break       # drag holds it
            gap = target - self.speed
            limited = self.accel_limit * self.lag   # m/s: above this gap the acceleration is limited
            if abs(gap) > limited + 1e-12 * (abs(self.speed) + abs(target)):    # by more than rounding
                acceleration = copysign(self.accel_limit, gap)
                time = (abs(gap) - limited) / self.accel_limit
                if self.speed and (self.speed > 0) != (gap > 0):
                    stop = -self.speed / acceleration
                    if stop <= min(time, duration):
                        travel += self.speed * stop / 2
                        self.speed = 0.0
                        duration -= stop
                        continue
                time = min(time, duration)
                travel += (self.speed + acceleration * time / 2) * time
                self.speed += acceleration * time
            else:
                time = duration
                if self.speed and target and (self.speed > 0) != (target > 0):
                    time = min(time, self.lag * log(1 - self.speed / target))
                closed = gap * (1 - exp(-time / self.lag))
                travel += target * time - closed * self.lag
                # a wheel that stops before the end of the duration stops exactly
                self.speed = self.speed + closed if time == duration else 0.0
            duration -= time
        return travel


class Encoder:
    """Counts whole ticks, rounded to the nearest."""

    def __init__(self, ticks_meter):
        """ticks_meter: ticks per metre."""
        self.ticks_meter = ticks_meter
        self.total = 0.0    # m, of the wheel
        self.ticks = 0

    def count(self, travel):
        """The counted travel (m) while the wheel travels `travel` (m)."""
        self.total += travel
        before, self.ticks = self.ticks, floor(self.total * self.ticks_meter + 0.5)
        return (self.ticks - before) / self.ticks_meter


class Delay:
    """Commands, each of them passed on after the same time."""

    def __init__(self, delay):
        """delay: s, above 0."""
        self.delay = delay
        self.clear()

    def clear(self):
        """Forget the commands that are under way."""
        self.parts = deque([[0.0, 0.0, self.delay]])     # m/s, rad/s, and for how long: s

    @property
    def is_empty(self):
        """Whether no command to move is under way."""
        return not any(linear or angular for linear, angular, _ in self.parts)

    def over(self, linear, angular, duration):
        """Yields (linear, angular, duration) of what is passed on while a command is in force for `duration` (s)."""
        parts = self.parts
        if parts[-1][:2] == [linear, angular]:
            parts[-1][2] += duration
        else:
            parts.append([linear, angular, duration])
        while duration > 0:
            linear, angular, left = parts[0]
            if left > duration or len(parts) == 1:
                parts[0][2] -= duration
                yield linear, angular, duration
                return
            parts.popleft()
            yield linear, angular, left
            duration -= left


class Wheels:
    """Two wheels with delay, inertia, drag and slip on a floor that is not even, and encoders that count whole ticks.

    Both motors are alike, so their common motion (straight) and their opposite motion (turning) are independent; each
    has its own drag and slip.
    """

    def __init__(self, base_width, surface, run, window, roughness=None):
        """base_width: m; surface: a Surface; run: the Run drawn from it; window: s, the time over which encoder counts
        are averaged to report a speed; roughness: a Roughness, or None."""
        self.window = window
        self.base_width = base_width
        self.surface = surface
        self.run = run
        self.roughness = roughness
        self.delay = Delay(surface.delay) if surface.delay else None
        self.straight = Motor(surface.lag, surface.accel_limit, surface.drag_straight)
        self.turning = Motor(surface.lag, surface.accel_limit, surface.drag_turning)
        self.left = Encoder(surface.ticks_meter)
        self.right = Encoder(surface.ticks_meter)
        self.truth = Odometry(base_width)
        self.reset()

    def travel(self, linear, angular, duration):
        """(left, right) travel in m that the encoders count while `linear` (m/s) and `angular` (rad/s) are in force."""
        if self.delay:
            straight = turning = 0.0
            for speed, rate, part in self.delay.over(linear, angular, duration):
                straight += self.straight.travel(speed, part)
                turning += self.turning.travel(rate * self.base_width / 2, part)
        else:
            straight = self.straight.travel(linear, duration)
            turning = self.turning.travel(angular * self.base_width / 2, duration)
        self._rolling = bool(straight or turning or self.straight.speed or self.turning.speed)
        turn = 2 * turning / self.base_width
        distance, angle = self._on_the_floor(straight, turn)
        if self.roughness and self._rolling:
            further, more = self.roughness.over(straight, turn)
            distance, angle = distance + further, angle + more
        self.truth.move(distance, angle)
        left, right = self.left.count(straight - turning), self.right.count(straight + turning)
        self._update_velocity(left, right, duration)
        return left, right

    def velocity(self, *_):
        """The speeds by the encoders' latest counts, whatever is commanded."""
        return self._velocity

    def true_velocity(self, *_):
        """The motors' speeds less slip, whatever is commanded."""
        return self._on_the_floor(self.straight.speed, 2 * self.turning.speed / self.base_width)

    def _on_the_floor(self, straight, turn):
        """What the robot makes of its wheels' travel, or speeds, without noise."""
        surface, run = self.surface, self.run
        distance = straight * (1 - run.slip_straight)
        if surface.turning_loss:
            distance = copysign(max(0.0, abs(distance) - surface.turning_loss * abs(turn)), distance)
        return distance, turn * (1 - run.slip_turning) + surface.curvature * straight

    @property
    def at_rest(self):
        """Whether nothing moved in the last step, and the reported speeds are 0."""
        return not (self._rolling or any(self._velocity) or self.delay and not self.delay.is_empty)

    def _update_velocity(self, left, right, duration):
        self._distance += (left + right) / 2
        self._angle += (right - left) / self.base_width
        self._time += duration
        if self._time > 0.75 * self.window:     # steps differ a little from their nominal length
            self._velocity = self._distance / self._time, self._angle / self._time
            self._path += abs(self._distance)
            self._turned += abs(self._angle)
            self._time = self._distance = self._angle = 0.0

    @property
    def uncertainty(self):
        """Uncertainty of the odometry.

        Of the pose: the sum of all slip, an upper bound, since the way back may undo it. Of the speeds: rounding to
        whole ticks over the window, with a variance of 1/6 tick^2 as the difference of two roundings (1/12 each), and
        the floor's noise. The speeds of a standing robot are known.
        """
        surface = self.surface
        yaw = hypot(surface.slip_turning, surface.slip_turning_spread) * self._turned
        position = hypot(hypot(surface.slip_straight, surface.slip_straight_spread), yaw) * self._path
        tick = 1 / surface.ticks_meter
        length, heading = self._noise(self._path, self._turned)
        position = position ** 2 + tick ** 2 + length + heading * self._path ** 2
        yaw = yaw ** 2 + (tick / self.base_width) ** 2 + heading
        if self.at_rest:
            return Uncertainty(position, yaw, MEASURED, MEASURED)
        wheel = tick ** 2 / 6 / self.window ** 2
        length, heading = self._noise(*map(abs, self._velocity))
        return Uncertainty(position, yaw, MEASURED + wheel / 2 + length / self.window,
                           MEASURED + 2 * wheel / self.base_width ** 2 + heading / self.window)

    def _noise(self, path, turned):
        """Variances of the length (m^2) and the heading (rad^2) after a path (m) and turns (rad), by the noise."""
        surface = self.surface
        return (surface.distance_noise ** 2 * path,
                surface.heading_noise_turning ** 2 * turned + surface.heading_noise_straight ** 2 * path)

    def reset(self):
        """Put the robot back at the origin, at rest."""
        self.straight.speed = self.turning.speed = 0.0
        if self.delay:
            self.delay.clear()
        self._rolling = False
        self._velocity = 0.0, 0.0
        self._time = self._distance = self._angle = 0.0     # s, m and rad since the last velocity
        self._path = self._turned = 0.0     # m and rad, both directions counted positive
        self.truth.pose = ORIGIN
