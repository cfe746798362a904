"""Standstill: decides from odometry and gyro together whether the robot is at rest, and learns the gyro's bias there.

The wheels may be at rest if the odometry stays where it is, except for a creep, and for ticks that come and go. Then
the turn of the gyro is summed up over WINDOW or longer:

- standstill: the turn is what the known bias and the noise explain. Its rate is the bias, and the heading is kept.
- undecided: it is not, but the rate is within STEADY of the bias. Either the bias has changed, or the robot turns so
  slowly that its wheels hardly show it. The robot turns as the gyro measures until the turn is TELLING: if the wheels
  have moved, the robot is not at rest; otherwise, the bias has changed.
- carried: any other rate. Somebody turns the robot, which turns as the gyro measures, at an uncertain position. If the
  rate is steady, the bias may have changed instead: the heading is uncertain by the whole turn until the old rate is
  back.

A turn that the wheels do not show, slower than STEADY, cannot be told from a bias that has changed. If the bias changes
in a rest, the heading is therefore as uncertain as that turn. Before the first rest, no bias is known, so any rate that
is steady may be the bias.
"""
from __future__ import annotations

from math import degrees, hypot, sqrt

from rbx1_nav.base.kinematics import Pose
from rbx1_nav.base.units import wrap_angle
from rbx1_nav.filter.filter import CLEAR, RARE, STEADY, TICK, Filter
from rbx1_nav.filter.gyro_readings import Measurement
from rbx1_nav.filter.pose_errors import BIAS, PERIOD, Yaw

STANDSTILL, UNDECIDED, CARRIED = 'standstill', 'undecided', 'carried'

WINDOW = PERIOD / 2     # s over which the turn is summed up at least; two of them count
SAME = 1e-4             # m and rad: a smaller change is rounding
MOVE = 0.5              # m/rad * tick: both wheels may be off by one; 1 mm for a turn of 0.004 rad
CREEP = 0.0005          # m/s: a TurtleBot3 in its simulator creeps by 0.2 mm/s,
CREEP_TURN = 0.001      # rad/s: and turns by 0.05 degrees/s (fuse, turtlebot3.bag)
STILL = 250.0           # s/rad * tick: length of a first window; a turn of 0.3 degrees/s would show in it
TURN, TELLING = 2.1, 8.0        # ticks: both wheels may be off by one; they report more than that in such a turn, even
#                                 if the robot turns twice as far as they report
DOUBTFUL = 2 * PERIOD   # s for which another rate must be steady to be possibly the bias


class Standstill:
    """Watches the odometry and the gyro, and updates the filter while the wheels are at rest."""

    def __init__(self, max_bias: float) -> None:
        """max_bias: rad/s, the largest bias of a gyro."""
        self.max_bias = max_bias
        self.tick = TICK        # rad: the smallest turn that the odometry has reported
        self.restart()

    def restart(self) -> None:
        """Wait for the next standstill."""
        self.case: str | None = None
        self.anchor: Pose | None = None     # the pose of the wheels at the start of the window
        self._begin(None)
        self._rest()
        self.turning = 0.0      # s for which the robot has been turned
        self.steady = self.doubted = 0.0    # s, rad: turn at a steady rate that is not the bias
        self.changed: float | None = None   # rad/s: change of the bias in this rest; None until it is learned

    def _begin(self, pose: Pose | None) -> None:
        self.anchor = pose
        self.time = self.angle = self.variance = 0.0    # s, rad, rad^2: what the gyro has measured in the window
        self.exact = self.crept = True      # whether the wheels have not moved at all, or only crept

    def _rest(self) -> None:
        self.waiting = 0.0, 0.0, 0.0    # of the previous window, used if the robot is still at rest

    def stands(self, pose: Pose, turned: float) -> bool:
        """Return whether the wheels may be at rest at their new pose, after a turn (rad)."""
        if abs(turned) > SAME:
            self.tick = min(self.tick, abs(turned))
        last = self.anchor
        if last:
            moved, turned = hypot(pose.x - last.x, pose.y - last.y), abs(wrap_angle(pose.yaw - last.yaw))
            self.exact = self.exact and moved <= SAME and turned <= SAME
            crept, crept_turn = CREEP * self.time, CREEP_TURN * self.time
            self.crept = moved <= SAME + crept and turned <= SAME + crept_turn
            return moved <= MOVE * self.tick + crept and turned <= TURN * self.tick + crept_turn
        return False

    def leave(self, pose: Pose, ekf: Filter) -> None:
        """Wait for the next standstill, because the wheels have moved to a pose, or the gyro is missing."""
        if self.case or self.time or self.waiting[0]:
            self._release(ekf)
            if self.steady > DOUBTFUL:
                ekf.doubt_bias(ekf.bias + self.doubted / self.steady)
            else:
                self._believe_turn(ekf)
            self.restart()
        self.anchor, self.exact = pose, True

    def _release(self, ekf: Filter) -> None:
        """Turn the robot by what the gyro has measured in the last two windows, in which it may have begun to turn."""
        if self.case == STANDSTILL:
            time, angle, _ = self.waiting
            time += self.time
            ekf.step(time, Yaw(angle + self.angle - ekf.bias * time, 0.0, True))

    def add(self, duration: float, gyro: Measurement, pose: Pose, ekf: Filter) -> str:
        """Add a step (s) at rest, which ends at a pose of the wheels. Return a text if the user should know."""
        rate, margin = gyro[0] / duration, STEADY + CLEAR * sqrt(gyro[1]) / duration
        usual = ekf.bias if ekf.rested else self.angle / self.time if self.time else rate
        if abs(rate) > self.max_bias or abs(rate - usual) > margin + (2 * ekf.sigma(BIAS) if ekf.rested else 0.0):
            return self._carry(duration, rate, margin, ekf)
        self._believe_turn(ekf)     # the rate is that of the bias again, so the robot was turned
        if not ekf.rested:      # nothing is known of the bias, and the wheels do not turn
            self.case = STANDSTILL
        elif self.case == CARRIED:
            self.case = None
        self.turning = 0.0
        if self.changed:
            ekf.doubt_turn(self.changed * duration)
        self.time, self.angle, self.variance = self.time + duration, self.angle + gyro[0], self.variance + gyro[1]
        least = 0.0 if ekf.rested or self.waiting[0] else self.tick * STILL
        if self.time < max(WINDOW, least) - 1e-6:
            return ''
        turn = abs(self.angle - ekf.bias * self.time)
        drifted = ekf.rested and turn ** 2 > RARE ** 2 * (self.variance + (ekf.sigma(BIAS) * self.time) ** 2)
        if drifted and turn < self.tick * TELLING / (1 + self.exact):   # still wheels report a tick in half of it
            self._release(ekf)
            self._rest()
            self.case = UNDECIDED
            return ''
        change, (time, angle, variance) = 0.0, self.waiting
        self.waiting = self.time, self.angle, self.variance
        self._begin(pose if self.crept else self.anchor)
        if drifted or time:
            time, angle, variance = self.waiting if drifted else (time, angle, variance)
            before = ekf.bias
            change = ekf.learn_bias(angle / time, variance / time ** 2)
            if self.changed is None:
                self.changed = 0.0
            elif change or self.changed:
                self.changed += ekf.bias - before
            self.case = STANDSTILL
        return (f'the bias of imu_data has changed by {degrees(change):.2f} degrees/s since the last rest: the heading '
                f'is uncertain' if change else '')

    def _carry(self, duration: float, rate: float, margin: float, ekf: Filter) -> str:
        """Add a step (s) in which the robot is turned at a rate (rad/s), or the bias has changed to that rate."""
        self._release(ekf)
        self._begin(self.anchor)    # a creep does not count
        self._rest()
        self.case = CARRIED
        self.turning += duration
        if self.turning > WINDOW:       # wheels may report a turn later than the gyro
            ekf.carry(duration)
        offset = rate - ekf.bias
        if self.steady and abs(offset - self.doubted / self.steady) > margin:    # no bias changes like this
            self._believe_turn(ekf)
        before, self.steady, self.doubted = self.steady, self.steady + duration, self.doubted + offset * duration
        ekf.doubt_turn(offset * duration)
        return (f'the wheels are at rest, and imu_data turns steadily by {degrees(offset):.1f} degrees/s: somebody '
                'turns the robot, or the bias has changed; the heading is uncertain'
                if before <= DOUBTFUL < self.steady else '')

    def _believe_turn(self, ekf: Filter) -> None:
        """Do not doubt any more that the robot was turned."""
        if self.steady:
            ekf.doubt_turn(-self.doubted)
            self.steady = self.doubted = 0.0
