"""The exercise by odometry: a list of legs, each of which ends when the robot's pose says so."""
from collections import deque
from math import cos, pi, sin, sqrt

from rbx1_nav.control.motions import ticks
from rbx1_nav.units import wrap_angle

SLOW_DOWN = 0.5     # s: the distance at which a leg begins to slow down, as a travel time
SPEED_WINDOW = 0.1  # s over which the robot's speed is measured: a few counts of the encoders, a message or two
COASTING = 1.0      # s: how long a robot that is no longer commanded may go on
POSE_TOLERANCE = 0.1    # m, and twice as many rad: what a pose may be corrected by at once
STUCK_TIME = 5.0    # s without progress: something holds the robot, or turns it the wrong way


def is_reachable(before, after, elapsed, linear_speed, angular_speed):
    """Whether a robot that drives forward (m/s) and turns left (rad/s) can get from one Pose to another in `elapsed` s.

    Half as fast again is allowed. A robot whose pose is lost for long is stopped, so no more than COASTING counts.
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
    """A leg that makes no progress towards its goal."""


class Leg:
    """One motion, slower and slower towards its goal, with a trial stop just before it.

    A robot rolls on after a stop. How far depends on the robot, the floor, and all delays in between. The trial stop
    measures it. Then the robot goes on at its lowest speed, and stops that far before the goal. So a leg is driven in two
    parts, with a rest between them.
    """

    def __init__(self, name, goal, speed, min_speed, rate):
        """goal: m or rad; speed, min_speed: m/s or rad/s; rate: of the calls, Hz. Raises ValueError, see ticks()."""
        self.name = name
        self.goal = goal
        self.speed = speed
        self.min_speed = min(min_speed, speed)
        self.rate = rate
        self.start = self.last = None   # Pose
        self.turned = 0.0       # rad
        self.nearest = goal     # m or rad
        self.patience = self.stuck_ticks = max(2, int(min(STUCK_TIME * rate, 1e9)))
        self.recent = deque(maxlen=1 + round(min(max(1, SPEED_WINDOW * rate), 1000)))   # m or rad to go
        self.trial = None       # m or rad to go, and travel per tick, when the trial stop began
        self.roll_out = None    # m or rad from there to the standstill
        self.finished = False
        try:
            ticks(goal, self.min_speed, rate)
        except ValueError as error:
            raise ValueError(f'{self.keys}: at the lowest speed, {error}')

    def next_speed(self, pose):
        """The speed for the next tick, with the robot at `pose`. Raises StuckError.

        0 is a stop: first the trial stop, after which it is called again when the robot is at a standstill; then the goal.
        """
        if self.start is None:
            self.start = self.last = pose
        self.turned += wrap_angle(pose.yaw - self.last.yaw)
        self.last = pose
        to_go = self.goal - self.done()
        if self.trial and self.roll_out is None:
            self.roll_out = max(0.0, self.trial[0] - to_go)
            self.recent.clear()
        self.recent.append(to_go)
        travel = max(0.0, self.recent[0] - to_go) / max(1, len(self.recent) - 1)    # m or rad per tick
        # half of a tick's travel is as near as it can get
        if self.finished or to_go - self._expected_roll_out(travel) <= min(travel, self.min_speed / self.rate) / 2:
            self.finished = True
            return 0.0
        self.patience -= 1
        if to_go < self.nearest - self.min_speed / self.rate:
            self.nearest = to_go
            self.patience = self.stuck_ticks
        if self.patience < 0:
            raise StuckError('%s: no progress for %g s, %.3f of %.3f %s to go'
                             % (self.name, STUCK_TIME, to_go, self.goal, self.unit))
        # it has reached its lowest speed, with SLOW_DOWN left to go on at it
        if not self.trial and to_go < SLOW_DOWN * self.min_speed:
            self.trial = to_go, max(travel, 1e-9)   # never divide by 0
            return 0.0
        # no faster than it can brake, and never past the goal within two ticks
        limit = min(to_go / max(SLOW_DOWN, 2 / self.rate), sqrt(2 * self.deceleration * to_go))
        return min(self.speed, max(self.min_speed, limit))

    def _expected_roll_out(self, travel):
        """How far the robot would roll on (m or rad): as in the trial stop, or less if it is slower now.

        travel: per tick, m or rad.
        """
        return self.roll_out * min(1.0, travel / self.trial[1]) if self.roll_out else 0.0


class Straight(Leg):
    """Forward, in m and m/s."""

    unit = 'm'
    keys = 'goal_distance, min_linear_speed'
    deceleration = 0.4      # m/s^2

    def done(self):
        """The distance covered in the direction of the start, m."""
        return ((self.last.x - self.start.x) * cos(self.start.yaw) + (self.last.y - self.start.y) * sin(self.start.yaw))

    @staticmethod
    def velocity(speed):
        """(linear, angular) for a speed."""
        return speed, 0.0


class Turn(Leg):
    """To the left on the spot, in rad and rad/s."""

    unit = 'rad'
    keys = 'goal_angle, min_angular_speed'
    deceleration = 2.0      # rad/s^2

    def done(self):
        """The angle turned, rad."""
        return self.turned

    @staticmethod
    def velocity(speed):
        """(linear, angular) for a speed."""
        return 0.0, speed


def out_and_back_by_odometry(linear_speed, goal_distance, angular_speed, goal_angle, rate, min_linear_speed,
                             min_angular_speed):
    """The same exercise as four Legs; in m/s, m, rad/s, rad, Hz, m/s and rad/s. Raises ValueError, see ticks()."""
    return [leg for _ in range(2)
            for leg in (Straight('forward', goal_distance, linear_speed, min_linear_speed, rate),
                        Turn('turn left', goal_angle, angular_speed, min_angular_speed, rate))]
