"""The combined odometry: sorts the messages, handles dropouts and jumps, and steps the filter."""
from __future__ import annotations

from collections import deque
from copy import deepcopy
from math import cos, sin
from typing import Callable, Deque, NamedTuple

from rbx1_nav.base.kinematics import Pose
from rbx1_nav.base.units import SECOND, Covariance, wrap_angle
from rbx1_nav.filter.filter import ENOUGH_TURN, Filter
from rbx1_nav.filter.gyro_readings import Readings
from rbx1_nav.filter.input_checks import Imu, Odom, check_imu, check_odom, distance, format_pose, has_jumped
from rbx1_nav.filter.pose_errors import Yaw
from rbx1_nav.filter.priors import UNKNOWN_FLOOR, Priors, Bounds
from rbx1_nav.filter.sensor_contradictions import Doubts
from rbx1_nav.filter.sensor_timeouts import IMU, MAX_LEAD, MAX_WAIT, ODOM, Arrivals
from rbx1_nav.filter.standstill import CARRIED, STANDSTILL, Standstill
from rbx1_nav.filter.velocity import Motion, Velocity, velocity


AT_REST = Yaw(0.0, 0.0, False)


class Estimate(NamedTuple):
    stamp: int          # ns
    pose: Pose
    covariance: Covariance      # 3x3, of x, y (m) and yaw (rad)
    odom: Odom          # the last odometry that the estimate is based on


class CombinedOdometry:
    """Runs the filter on messages in the order of their stamps, with one step per odometry message.

    A step waits until the gyro has reported up to the stamp of the odometry. So from the arrival of the first odometry
    on, the result depends only on stamps (ns), not on arrivals, as long as no sensor times out. A sensor has timed out
    if the other sensor's stamps are ahead by more than `timeout`, and nothing has arrived from it for that time: a late
    sensor is not silent. A sensor that has timed out is not used until it recovers. Without the gyro, the wheels
    measure the turn. Without odometry, there is no estimate; when it recovers, both sensors have measured the turn in
    the dropout.
    """

    def __init__(self, prior: Priors, timeout: int, gyro_used: bool = True,
                 warn: Callable[[str], None] = lambda text: None, clock: Callable[[], int] | None = None,
                 max_lead: int = MAX_LEAD, limits: Bounds = Bounds()) -> None:
        """timeout: ns; gyro_used: whether to wait for a gyro at all; warn(text): logs a warning; clock(): returns the
        arrival time (ns) if `now` may be simulated time; max_lead: ns that a stamp may be ahead."""
        self.prior = prior
        if prior == UNKNOWN_FLOOR:
            self.prior = prior._replace(gyro_scale_error=limits.gyro_scale_error,
                                        gyro_measurement_range=limits.max_turn_rate)
        self.limits = limits
        self.timeout = timeout
        self.gyro_used = gyro_used
        self.warn = warn
        self.arrivals = Arrivals(timeout, warn, clock, max_lead)
        self.readings = Readings(limits)
        self.filter: Filter | None = None
        self.learned: Filter | None = None
        self.standstill = Standstill(limits.gyro_bias)
        self.doubts = Doubts(warn)
        self.unmeasured = 0.0       # rad: turn of the wheels while the gyro has never changed
        self.restart()

    def reset(self, now: int) -> None:
        """Restart, because the base was reset at `now` (ns), on a clock that may differ from the clock of the stamps.
        Odometry from before the reset is ignored if it arrives less than a second late."""
        self.restart()
        last = max((stamp for stamp in self.arrivals.last_stamp.values() if stamp), default=now)
        self.start = max(last, min(now, last + SECOND))

    def restart(self, reason: str = '') -> None:
        """Discard the estimate; the next odometry message gives the initial pose."""
        if reason:
            self.warn(f'{reason}: restarting at the odometry pose')
        self.start = 0              # ns, stamp of the first message that counts
        self.learned = self.filter or self.learned      # about the sensors, which a restart does not change
        self.filter = None
        self._estimate: Estimate | None = None      # the latest one, once it was requested
        self.pending: Deque[tuple[int, Odom]] = deque()     # with arrival times (ns), until the gyro has caught up
        self.readings.waiting.clear()
        self.odom: Odom | None = None       # the last odometry that was used in a step
        self.motion: Motion | None = None   # in that step; None if it was not the next one
        self.standstill.restart()
        self.placed: tuple[int, Pose, Covariance] | None = None     # arguments of set_pose(), until a step after it
        self.suspect: Odom | None = None    # odometry that has jumped, until the next message confirms it
        self.arrivals.restart()

    @property
    def pose(self) -> Pose | None:
        """The pose of the filter; None before the first odometry."""
        return self.filter.state if self.filter else None

    @property
    def estimate(self) -> Estimate | None:
        """The latest Estimate, the same object until the next step; None before the first odometry."""
        ekf, odom = self.filter, self.odom
        if not self._estimate and ekf and odom:
            self._estimate = Estimate(odom.stamp, ekf.state, ekf.covariance, odom)
        return self._estimate

    @property
    def velocity(self) -> Velocity | None:
        """The Velocity in the last step; None after a start or a restart."""
        ekf, odom, motion = self.filter, self.odom, self.motion
        return velocity(motion, odom, ekf, self.contradicts) if ekf and odom and motion else None

    @property
    def timed_out(self) -> dict[str, bool]:
        """For each sensor, whether it has timed out and is not used."""
        return self.arrivals.timed_out

    @property
    def contradicts(self) -> bool:
        """Whether wheels and gyro contradict each other."""
        ekf = self.filter
        return ekf is not None and (ekf.gyro_left or ekf.contradicts)

    @property
    def case(self) -> str | None:
        """The rule that the last step has followed: 'standstill', 'carried', 'contradiction', or otherwise 'agreement'.
        None if a sensor is missing, or if the last odometry was ignored."""
        if not self.filter or not self.gyro_used or self.suspect or any(self.timed_out.values()):
            return None
        case = self.standstill.case
        return case if case in (STANDSTILL, CARRIED) else 'contradiction' if self.contradicts else 'agreement'

    # input

    def set_pose(self, now: int, pose: Pose, covariance: Covariance) -> None:
        """Set the robot's Pose at `now` (ns), with its covariance (3x3) of x, y (m) and yaw (rad). It takes effect at
        once, or before the first step beyond `now`. The filter keeps what it has learned about the sensors."""
        self.placed = now, pose, covariance
        if self.filter and self.odom and self.odom.stamp >= now:
            self._place(self.filter)
            self._estimate = None

    def add_odom(self, now: int, odom: Odom) -> None:
        """Process an Odom that arrived at `now` (ns). Raises RejectedMessage."""
        check_odom(odom)
        self._arrive(ODOM, now, odom.stamp)
        if odom.stamp >= self.start:
            self.pending.append((self.arrivals.time, odom))
            self._make_steps()

    def add_imu(self, now: int, imu: Imu) -> None:
        """Process an Imu that arrived at `now` (ns). Raises RejectedMessage."""
        check_imu(imu)
        before = self._arrive(IMU, now, imu.stamp)
        # the first reading after a dropout covers a period whose start is unknown
        if (self.odom or self.pending) and before is not None and imu.stamp - before <= self.timeout:
            self.readings.add(imu, self.standstill.case == STANDSTILL)
        self.readings.last = imu
        self._make_steps()

    def _arrive(self, sensor: str, now: int, stamp: int) -> int | None:
        """Check and store a stamp; return the previous stamp, or None."""
        back = self.arrivals.notice_step_back(now)
        if back:
            self.restart(f'The clock jumped back by {back / SECOND:.3f} s')
        return self.arrivals.add(sensor, now, stamp)

    # steps

    def _make_steps(self) -> None:
        """Make all steps for which there are messages."""
        while self.pending and self._gyro_is_ready():
            self._step(self.pending.popleft()[1])
        reported = self.arrivals.last_stamp[IMU] or 0
        if (self.odom and not self.pending and reported - self.odom.stamp > self.timeout
                and self.arrivals.is_silent(ODOM, 0)):
            self.arrivals.set_timed_out(ODOM)

    def _gyro_is_ready(self) -> bool:
        """Return whether the gyro has reported up to the first pending odometry, or there is no need to wait for it."""
        (arrival, first), (_, last) = self.pending[0], self.pending[-1]
        reported = self.arrivals.last_stamp[IMU]
        if (reported is not None and reported >= first.stamp) or not self.gyro_used or self.timed_out[IMU]:
            return True
        if self.arrivals.time - arrival > MAX_WAIT:
            self.arrivals.set_timed_out(IMU, f'its messages arrive more than {MAX_WAIT / SECOND:g} s late')
        elif (last.stamp - (first.stamp if reported is None else reported) > self.timeout
              and self.arrivals.is_silent(IMU, arrival)):
            self.arrivals.set_timed_out(IMU)
        return self.timed_out[IMU]

    def _step(self, odom: Odom) -> None:
        if self.odom and self._reject_outlier(self.odom, odom):
            return
        ekf = self.filter
        if ekf and self.odom:
            if self.placed and odom.stamp > self.placed[0]:
                self._place(ekf)
            self._move(ekf, self.odom, odom)
        else:
            ekf = self.filter = deepcopy(self.learned) or Filter(self.prior, odom.pose, self.limits.gyro_bias)
            ekf.place(odom.pose)
            if self.placed:
                self._place(ekf)
        self.odom, self._estimate = odom, None

    def _reject_outlier(self, last: Odom, odom: Odom) -> bool:
        """Store an Odom that has jumped, and return True: it is ignored. If a second one agrees, restart there."""
        suspect, self.suspect = self.suspect, None
        if suspect and not has_jumped(suspect, odom, self.limits) and distance(suspect, odom) <= distance(last, odom):
            self.restart(f'odom: jumped from {format_pose(last)} to {format_pose(odom)}')
        elif has_jumped(last, odom, self.limits):
            self.warn(f'odom: {format_pose(odom)} is too far from {format_pose(last)} for the '
                      f'{(odom.stamp - last.stamp) / SECOND:.3f} s between them (~max_speed, ~max_turn_rate): ignored')
            self.suspect = odom
        return self.suspect is not None

    def _move(self, ekf: Filter, last: Odom, odom: Odom) -> None:
        """Move the robot from one Odom to the next, as wheels and gyro have measured."""
        start, (last_x, last_y, last_yaw), _, _ = last
        end, (x, y, yaw), linear_variance, angular_variance = odom
        duration = (end - start) / SECOND
        gyro = self.readings.turn(start, end, self.prior.gyro_measurement_range)
        dx, dy, turned = x - last_x, y - last_y, wrap_angle(yaw - last_yaw)
        middle = last_yaw + turned / 2      # in the frame of the robot halfway through the turn
        c, s = cos(middle), sin(middle)
        forward, left = dx * c + dy * s, dy * c - dx * s
        case, stands = None, gyro is not None and self.standstill.stands(odom.pose, turned)
        if gyro and not stands and self.readings.dead and turned and abs(turned - gyro[0]) > abs(turned) / 2:
            self.unmeasured += abs(turned)
            if self.unmeasured > ENOUGH_TURN:
                ekf.leave_gyro()
                self.doubts.report('dead', ekf)
            gyro = None
        if gyro and stands:
            text = self.standstill.add(duration, gyro, odom.pose, ekf)
            if text:
                self.warn(text)
            case = self.standstill.case
        else:
            self.standstill.leave(odom.pose, ekf)
        turn = AT_REST if case == STANDSTILL else ekf.turn(
            duration, (turned, angular_variance * duration ** 2), gyro, forward)
        used = gyro if case == STANDSTILL or turn.by_gyro else None
        self.motion = Motion(duration, forward, left, turned, used, case == CARRIED)
        ekf.step(duration, turn, 0.0 if case == STANDSTILL else turned, forward, left,
                 linear_variance * duration ** 2)
        found = ekf.compare(duration, turned, gyro, forward)
        if found is not None:
            ekf.doubted = found or ekf.doubted
            self.doubts.report(found if ekf.rested else found or 'rest', ekf)

    def _place(self, ekf: Filter) -> None:
        """Move the filter to the pose of set_pose()."""
        assert self.placed
        (_, pose, covariance), self.placed = self.placed, None
        ekf.place(pose, covariance)
