"""The exercise: timed motions, each a velocity for a number of ticks, and legs, each of which stops when the robot's
pose has reached its goal.
"""
from __future__ import annotations

from abc import ABC, abstractmethod
from collections import deque
from enum import Enum
from math import cos, isfinite, pi, sin, sqrt
from typing import NamedTuple

from rbx1_nav.base.kinematics import Pose
from rbx1_nav.base.units import wrap_angle

MAX_TICKS = 10 ** 8    # three weeks at 50 Hz
SLOW_DOWN = 0.5     # s: travel time to the goal at which a leg begins to slow down
SPEED_WINDOW = 0.1  # s over which the robot's speed is measured: a few encoder counts, one or two messages
COASTING = 1.0      # s: how long a robot may continue to move without a command
POSE_TOLERANCE = 0.1    # m, and twice this value in rad: largest correction of a pose in one message
TRIAL_REST = 0.5    # s at a trial stop, in which the robot coasts to rest
REST = 1.0          # s between two motions
STUCK_TIME = 5.0    # s without progress: something holds the robot, or turns it in the wrong direction


class Motion(NamedTuple):
    """One motion: the same command for a number of ticks."""

    name: str
    linear: float   # m/s
    angular: float  # rad/s, positive to the left
    ticks: int


def ticks(goal: float, speed: float, rate: float, keys: str = 'goal / speed') -> int:
    """Return the number of ticks that it takes to cover `goal` (m or rad) at `speed` (m/s or rad/s), rounded down.

    rate: ticks per second; keys: names of goal and speed, for the error message. Raises ValueError if the number is
    below 1 or above MAX_TICKS.
    """
    number = goal / speed * rate
    if not (isfinite(number) and 1 <= number + 1e-9 <= MAX_TICKS):
        raise ValueError(f'{keys} * rate: {goal:g} / {speed:g} * {rate:g}: {number:g} ticks: expected from 1 to '
                         f'{MAX_TICKS}')
    # 0.3 / 0.1 is a little less than 3 in floating point: do not lose a tick to that
    return int(number + 1e-9)


def out_and_back(linear_speed: float, goal_distance: float, angular_speed: float, goal_angle: float,
                 rate: float) -> list[Motion]:
    """Return the tutorial's exercise (forward and turn left, twice) as four Motions, as timed_out_and_back.py drives
    them. Raises ValueError, see ticks().

    The arguments are in m/s, m, rad/s, rad and Hz.
    """
    forward = Motion('forward', linear_speed, 0.0,
                     ticks(goal_distance, linear_speed, rate, 'goal_distance / linear_speed'))
    turn = Motion('turn left', 0.0, angular_speed, ticks(goal_angle, angular_speed, rate, 'goal_angle / angular_speed'))
    return [forward, turn, forward, turn]


def is_reachable(before: Pose, after: Pose, elapsed: float, linear_speed: float, angular_speed: float) -> bool:
    """Return whether a robot can get from one Pose to another in `elapsed` s.

    The robot drives forward at up to linear_speed (m/s) and turns left at up to angular_speed (rad/s). It may
    exceed both by 50 %. A robot that has been without a pose for a long time has been stopped, so at most COASTING of
    the time counts.
    """
    time = 1.5 * min(max(elapsed, 0.0), COASTING)
    x, y = after.x - before.x, after.y - before.y
    forward = x * cos(before.yaw) + y * sin(before.yaw)
    left = y * cos(before.yaw) - x * sin(before.yaw)
    turned = (after.yaw - before.yaw + 2 * POSE_TOLERANCE) % (2 * pi)
    return (-POSE_TOLERANCE <= forward <= linear_speed * time + POSE_TOLERANCE
            and abs(left) <= linear_speed * time + POSE_TOLERANCE
            and turned <= angular_speed * time + 4 * POSE_TOLERANCE)


class StuckError(ValueError):
    """Raised if a leg makes no progress toward its goal."""


class Phase(Enum):
    """The phase of a Leg."""

    NEW = 'no pose received yet'
    APPROACH = 'driving and slowing down'
    TRIAL_STOP = 'stopped just before the goal; the next call follows when the robot is stationary'
    LAST_PART = 'driving the rest of the leg, with a known stopping distance'
    FINISHED = 'stopped at the goal'


class Leg(ABC):
    """One motion that slows down toward its goal, with a trial stop just before the goal.

    No robot stops instantly. Its stopping distance depends on the robot, the floor, and all delays in between. The
    trial stop measures this distance. Then the robot continues at its lowest speed, and stops at this distance from the
    goal. So a leg is driven in two parts, with a rest between them. What a leg does must be possible for
    is_reachable(): otherwise the pose seems to jump.
    """

    unit: str
    rests = TRIAL_REST, REST    # s: at the trial stop, and at the goal
    keys: str               # configuration keys, for error messages
    deceleration: float     # m/s^2 or rad/s^2
    start: Pose             # pose at the first call of next_speed()
    last: Pose              # pose at the latest call

    def __init__(self, name: str, goal: float, speed: float, min_speed: float, rate: float) -> None:
        """goal: m or rad; speed, min_speed: m/s or rad/s; rate: call rate, Hz. Raises ValueError, see ticks()."""
        self.name = name
        self.goal = goal
        self.speed = speed
        self.min_speed = min(min_speed, speed)
        self.rate = rate
        self.slow_down = max(SLOW_DOWN, 2 / rate)       # s: never past the goal within two ticks
        self.state = Phase.NEW
        self.turned = 0.0       # rad
        self.nearest = goal     # m or rad
        self.patience = self.stuck_ticks = max(2, int(min(STUCK_TIME * rate, 1e9)))
        # m or rad to go at the latest calls
        self.recent: deque[float] = deque(maxlen=1 + round(min(max(1, SPEED_WINDOW * rate), 1000)))
        self.trial_to_go = 0.0      # m or rad to go when the trial stop began
        self.trial_travel = 0.0     # m or rad per tick at that moment
        self.roll_out = 0.0         # m or rad from that point until the robot is stationary
        try:
            ticks(goal, self.min_speed, rate)
        except ValueError as error:
            raise ValueError(f'{self.keys}: at the lowest speed, {error}') from error

    @abstractmethod
    def done(self) -> float:
        """Return how much of the goal has been covered, m or rad."""

    @staticmethod
    @abstractmethod
    def velocity(speed: float) -> tuple[float, float]:
        """Return (linear, angular) for a speed, m/s and rad/s."""

    def next_speed(self, pose: Pose) -> float:
        """Return the speed for the next tick, with the robot at `pose`. Raises StuckError.

        A speed of 0 is a stop. The first stop is the trial stop: make the next call when the robot is stationary. The
        second stop is the goal.
        """
        self._follow(pose)
        to_go = self.goal - self.done()
        if self.state is Phase.FINISHED:
            return 0.0
        if self.state is Phase.TRIAL_STOP:      # the robot is stationary now
            self.roll_out = max(0.0, self.trial_to_go - to_go)
            self.recent.clear()
            self.state = Phase.LAST_PART
        travel = self._measure_travel(to_go)
        # the robot cannot get closer to the goal than half of the travel per tick
        if to_go - self._expected_roll_out(travel) <= min(travel, self.min_speed / self.rate) / 2:
            self.state = Phase.FINISHED
            return 0.0
        self._check_progress(to_go)
        # the robot has reached its lowest speed, and is less than SLOW_DOWN from the goal
        if self.state is Phase.APPROACH and to_go < SLOW_DOWN * self.min_speed:
            self.trial_to_go = to_go
            self.trial_travel = max(travel, 1e-9)   # never divide by 0
            self.state = Phase.TRIAL_STOP
            return 0.0
        # slow enough to brake in time
        limit = min(to_go / self.slow_down, sqrt(2 * self.deceleration * to_go))
        return min(self.speed, max(self.min_speed, limit))

    def _follow(self, pose: Pose) -> None:
        """Update the leg with a new pose of the robot."""
        if self.state is Phase.NEW:
            self.start = self.last = pose
            self.state = Phase.APPROACH
        self.turned += wrap_angle(pose.yaw - self.last.yaw)
        self.last = pose

    def _measure_travel(self, to_go: float) -> float:
        """Return the robot's current travel per tick, m or rad."""
        recent = self.recent
        recent.append(to_go)
        return max(0.0, recent[0] - to_go) / max(1, len(recent) - 1)

    def _expected_roll_out(self, travel: float) -> float:
        """Return how far the robot would coast (m or rad): as far as in the trial stop, or less if it is slower now.

        travel: per tick, m or rad.
        """
        return self.roll_out * min(1.0, travel / self.trial_travel) if self.roll_out else 0.0

    def _check_progress(self, to_go: float) -> None:
        """Raise StuckError if the robot has not come closer to the goal for STUCK_TIME."""
        self.patience -= 1
        if to_go < self.nearest - self.min_speed / self.rate:
            self.nearest = to_go
            self.patience = self.stuck_ticks
        if self.patience < 0:
            raise StuckError(f'{self.name}: no progress for {STUCK_TIME:g} s, '
                             f'{to_go:.3f} of {self.goal:.3f} {self.unit} to go')


class Straight(Leg):
    """A straight leg forward, in m and m/s."""

    unit = 'm'
    keys = 'goal_distance, min_linear_speed'
    deceleration = 0.4      # m/s^2

    def done(self) -> float:
        """Return the distance covered in the direction of the initial heading, m."""
        (x, y, yaw), (last_x, last_y, _) = self.start, self.last
        return (last_x - x) * cos(yaw) + (last_y - y) * sin(yaw)

    @staticmethod
    def velocity(speed: float) -> tuple[float, float]:
        return speed, 0.0


class Turn(Leg):
    """A turn to the left on the spot, in rad and rad/s."""

    unit = 'rad'
    keys = 'goal_angle, min_angular_speed'
    deceleration = 2.0      # rad/s^2

    def done(self) -> float:
        """Return the angle turned, rad."""
        return self.turned

    @staticmethod
    def velocity(speed: float) -> tuple[float, float]:
        return 0.0, speed


def out_and_back_by_odometry(linear_speed: float, goal_distance: float, angular_speed: float, goal_angle: float,
                             rate: float, min_linear_speed: float, min_angular_speed: float) -> list[Leg]:
    """Return the odometry-based exercise as four Legs, as odom_out_and_back.py drives them. Raises ValueError, see
    ticks().

    The arguments are in m/s, m, rad/s, rad, Hz, m/s and rad/s.
    """
    return [leg for _ in range(2)
            for leg in (Straight('forward', goal_distance, linear_speed, min_linear_speed, rate),
                        Turn('turn left', goal_angle, angular_speed, min_angular_speed, rate))]
