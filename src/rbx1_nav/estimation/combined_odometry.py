"""The combined odometry: puts messages in order, handles dropouts and jumps, and steps the filter."""
from collections import deque, namedtuple
from math import cos, hypot, sin

from rbx1_nav.estimation.filter import BIAS, TURNING, UNKNOWN_FLOOR, X, Y, YAW, Filter
from rbx1_nav.estimation.inputs import RejectedMessage, check_imu, check_odom
from rbx1_nav.estimation.limits import Limits
from rbx1_nav.estimation.standstill import Part, Standstill
from rbx1_nav.robot.kinematics import Pose
from rbx1_nav.units import SECOND, wrap_angle

JUMP_TOLERANCE = 0.02   # m and rad in addition
DROPOUT_SPEED = 0.5     # m/s: how fast the robot may move (1 sigma) while no odometry arrives
SHORT = SECOND // 20    # ns between two readings in which the rate hardly changes
LOST = 1.5              # times the usual time between two readings: others between them were lost
MAX_LEAD = SECOND // 2  # ns that a stamp may be ahead of the clock: clocks of computers differ
MAX_AGE = 60 * SECOND   # ns that it may be behind; simulated time may be ahead of it or behind it by as much
CONTRADICTION = 5 * SECOND  # ns for which a contradiction is shown
MAX_WAIT = 5 * SECOND   # ns that odometry waits for a gyro that is late but not silent

Estimate = namedtuple('Estimate', 'stamp pose covariance odom')
Estimate.__doc__ = """The estimated pose: stamp in ns, Pose, 3x3 covariance of x, y (m) and yaw (rad), and the last Odom
that it is based on."""


def format_pose(odom):
    """The pose of an Odom as text."""
    return '(%.3f m, %.3f m, %.3f rad)' % odom.pose


def distance(one, other):
    """The distance between two Odoms, m."""
    return hypot(other.pose.x - one.pose.x, other.pose.y - one.pose.y)


def has_jumped(before, odom, limits):
    """Whether no robot within its Limits can have moved from the one Odom to the other in the time between them."""
    elapsed = (odom.stamp - before.stamp) / SECOND
    return (distance(before, odom) > limits.max_speed * elapsed + JUMP_TOLERANCE
            or abs(wrap_angle(odom.pose.yaw - before.pose.yaw)) > limits.max_turn_rate * elapsed + JUMP_TOLERANCE)


class CombinedOdometry:
    """Runs the filter on messages in the order of their stamps: one step per odometry message.

    A step waits until the gyro has reported up to its end. So the result depends on stamps (ns) only, and not on when
    messages arrive, as long as no sensor times out. A sensor has timed out if by stamps the other one is ahead by more
    than `timeout`, and nothing has arrived from it for as long: one that is late is not silent. It is not used until it
    recovers: without the gyro, the turn is measured by the wheels; without odometry, by the gyro, and the uncertainty
    of the position grows. The travel during a dropout of the odometry counts when it recovers.
    """

    def __init__(self, prior, timeout, gyro_used=True, warn=lambda text: None, clock=None, max_lead=MAX_LEAD,
                 limits=Limits()):
        """prior: Priors; timeout: ns; gyro_used: whether to wait for a gyro at all; warn(text): logs a warning;
        clock(): ns, tells when a message arrives if `now` may be simulated time; max_lead: ns, of a stamp."""
        self.prior = prior
        if prior == UNKNOWN_FLOOR:
            self.prior = prior._replace(gyro_scale_error=limits.gyro_scale_error,
                                        gyro_measurement_range=limits.max_turn_rate)
        self.limits = limits        # Limits
        self.timeout = timeout
        self.gyro_used = gyro_used
        self.warn = warn
        self.clock = clock
        self.max_lead = max_lead
        self.now = 0
        self.last_stamp = {'odom': None, 'imu_data': None}      # ns
        self.arrival = 0            # ns, of the last message of all, see _add_arrival()
        self.last_clock = 0         # ns, at that time
        self.last_imu = None        # Imu
        self.period = None          # ns, usual time between readings
        self.last_arrival = {'odom': None, 'imu_data': None}    # ns
        self.restart()

    def reset(self, now):
        """The base was reset at `now` (ns): restart. Odometry from before it, which may arrive later, does not
        count."""
        self.restart()
        self.start = max([now] + [stamp for stamp in self.last_stamp.values() if stamp])

    def restart(self, reason=None):
        """Forget everything; the next odometry message gives the initial pose."""
        if reason:
            self.warn(f'{reason}: restarting at the pose of the odometry')
        self.start = 0              # ns, stamp of the first message that counts
        self.filter = None
        self.estimate = None        # the latest Estimate
        self.pending = deque()      # (ns of arrival, Odom), until the gyro has caught up
        self.readings = deque()     # (ns at the start, Imu, variances of the rate: by its change, by lost readings)
        self.time = None            # ns, the end of the last step
        self.odom = None            # the last Odom of a step
        self.odom_yaw = None        # rad, the filter's yaw at that time
        self.yaws = deque()         # (ns, rad) of the filter since then, where the gyro is ahead of the odometry
        self.another_floor = False  # whether the sensors have shown that the prior is that of another floor
        self.contradicted = None    # ns, when wheels and gyro last contradicted each other
        self.standstill = Standstill(self.limits.gyro_bias)
        self.placed = None          # arguments of set_pose(), until the first step after that time
        self.placed_at = 0          # ns, the time of the last set_pose() that counts
        self.suspect = None         # an Odom that has jumped, until the next one confirms it
        self.timed_out = {'odom': False, 'imu_data': False}

    @property
    def contradicts(self):
        """Whether wheels and gyro contradict each other, or did so a moment ago."""
        return self.contradicted is not None and self.time - self.contradicted < CONTRADICTION

    @property
    def case(self):
        """Which rule the last step has followed: 'standstill', 'agreement', 'contradiction' or 'carried'; None without
        one of the sensors."""
        if not self.filter or not self.gyro_used or self.suspect or any(self.timed_out.values()):
            return None
        if self.standstill.case:
            return self.standstill.case
        return 'contradiction' if self.contradicts else 'agreement'

    # input

    def set_pose(self, now, pose, covariance):
        """The robot is at a Pose at `now` (ns), with this covariance (3x3) of x, y (m) and yaw (rad). What the filter
        has learned of the sensors is kept. It counts from the first step after `now`."""
        self.placed = now, pose, covariance
        if self.filter and self.time >= now:
            self._place()
            self._finish(self.time, None)

    def add_odom(self, now, odom, pose_variances):
        """Process an Odom that arrived at `now` (ns). Raises RejectedMessage.

        pose_variances: of x, y (m^2) and yaw (rad^2). They are used if the sender gives none for its speeds (0): as
        those of one second's travel, like in robot_pose_ekf.
        """
        check_odom(odom, pose_variances)
        if not (odom.linear_variance and odom.angular_variance):
            odom = odom._replace(linear_variance=pose_variances[0], angular_variance=pose_variances[2])
        self._check_stamp('odom', now, odom.stamp)
        if odom.stamp >= self.start:
            self.pending.append((self.arrival, odom))
            self._make_steps()

    def add_imu(self, now, imu):
        """Process an Imu that arrived at `now` (ns). Raises RejectedMessage."""
        check_imu(imu)
        before = self._check_stamp('imu_data', now, imu.stamp)
        # the first reading after a dropout covers a time whose start is unknown
        if (self.filter or self.pending) and before is not None and imu.stamp - before <= self.timeout:
            self._add_reading(self.last_imu, imu)
        self.last_imu = imu
        self._make_steps()

    def _add_reading(self, last, imu):
        """Store the reading that follows `last`. Its rate stands for the time since then, if that is short.

        In a longer time the rate may have been anything between the two. And if readings in between were lost, one that
        changes by at most A in a second makes the turn in a time T wrong by at most A T^2 / 4. Both errors are taken as
        uniformly distributed. The second one is kept apart, because the wheels may have measured the gap.
        """
        lost = changed = 0.0
        duration = imu.stamp - last.stamp
        usual = self.period or duration
        self.period = usual + (duration - usual) // 16      # a running mean
        if duration > SHORT:
            rate = imu.rate if imu.is_mean else (last.rate + imu.rate) / 2
            changed = (imu.rate - last.rate) ** 2 / 12
            if duration > LOST * usual:
                limits = self.limits
                lost = min(limits.max_angular_acceleration * duration / SECOND / 4, limits.max_turn_rate) ** 2 / 3
            imu = imu._replace(rate=rate)
        self.readings.append((last.stamp, imu, changed, lost))

    def _check_stamp(self, sensor, now, stamp):
        """Check and store a stamp; returns the previous one, or None."""
        if now < self.now - MAX_LEAD:
            self.restart(f'The clock jumped back by {(self.now - now) / SECOND:.3f} s')
            self.last_stamp = {'odom': None, 'imu_data': None}
        self.now = now
        before = self.last_stamp[sensor]
        for good, expected, time in ((stamp <= now + self.max_lead, 'a stamp not later than now', now),
                                     (stamp >= now - MAX_AGE, 'a stamp not much older than now', now),
                                     (before is None or stamp > before, 'a stamp later than the last', before or 0)):
            if not good:
                raise RejectedMessage(f'header.stamp: {stamp / SECOND:.9f}: expected {expected}, {time / SECOND:.9f}')
        self.last_stamp[sensor] = stamp
        self._add_arrival(sensor, self.clock() if self.clock else now)
        other = self.last_stamp['odom' if sensor == 'imu_data' else 'imu_data']
        # not if it is still as late as when it was given up
        if self.timed_out[sensor] and (sensor == 'odom' or (other or 0) - stamp <= MAX_WAIT):
            self.timed_out[sensor] = False
            self.warn(f'{sensor} has recovered')
        return before

    def _add_arrival(self, sensor, clock):
        """Tell that a message arrives. A pause of both sensors counts little: the process may have been asleep, and the
        messages of the one be processed before those of the other."""
        self.arrival += min(max(0, clock - self.last_clock), self.timeout // 4)
        self.last_clock = clock
        self.last_arrival[sensor] = self.arrival

    def _is_silent(self, sensor, since):
        """Whether no message of a sensor has arrived for longer than the timeout. since: ns, if there was none yet."""
        last = self.last_arrival[sensor]
        return self.arrival - (since if last is None else last) > self.timeout

    def _set_timed_out(self, sensor, reason=None):
        if not self.timed_out[sensor]:
            self.timed_out[sensor] = True
            self.warn('%s has timed out: %s; not used until it recovers'
                      % (sensor, reason or 'no valid message for more than %g s' % (self.timeout / SECOND)))

    # steps

    def _make_steps(self):
        """Make all steps for which there are messages."""
        while self.pending and self._gyro_is_ready():
            self._step(self.pending.popleft()[1])
        if (self.filter and not self.pending and (self.last_stamp['imu_data'] or 0) - self.odom.stamp > self.timeout
                and self._is_silent('odom', 0)):
            self._set_timed_out('odom')
            self._step_by_gyro(self.last_stamp['imu_data'])

    def _gyro_is_ready(self):
        """Whether the gyro has reported up to the first pending odometry, or need not be waited for."""
        (arrival, first), (_, last), reported = self.pending[0], self.pending[-1], self.last_stamp['imu_data']
        if not self.gyro_used or self.timed_out['imu_data'] or reported is not None and reported >= first.stamp:
            return True
        if self.arrival - arrival > MAX_WAIT:
            self._set_timed_out('imu_data', f'its messages come more than {MAX_WAIT / SECOND:g} s late')
        elif (last.stamp - (first.stamp if reported is None else reported) > self.timeout
              and self._is_silent('imu_data', arrival)):
            self._set_timed_out('imu_data')
        return self.timed_out['imu_data']

    def _step(self, odom):
        if self.odom and odom.stamp <= self.odom.stamp:
            return
        # one message that jumps is an outlier; a second one that agrees with it is a new place
        suspect, self.suspect = self.suspect, None
        if (suspect and not has_jumped(suspect, odom, self.limits)
                and distance(suspect, odom) <= distance(self.odom, odom)):
            self.restart(f'odom: jumped from {format_pose(self.odom)} to {format_pose(odom)}')
        elif self.filter and has_jumped(self.odom, odom, self.limits):
            self.warn('odom: %s is too far from %s for the %.3f s between them (~max_speed, ~max_turn_rate): ignored'
                      % (format_pose(odom), format_pose(self.odom), (odom.stamp - self.odom.stamp) / SECOND))
            self.suspect = odom
            return
        if not self.filter:
            self.filter = Filter(self.prior, odom.pose, self.limits.gyro_bias)
            self.odom_yaw = odom.pose.yaw
            if self.placed:
                self._place()
            self._finish(odom.stamp, odom)
            return
        if self.placed and odom.stamp > self.placed[0]:
            self._place()

        elapsed = (odom.stamp - self.odom.stamp) / SECOND
        # the robot was put to its place at some time since the last odometry: only the rest of the distance counts
        share = min(1.0, max(0, odom.stamp - self.placed_at) / (odom.stamp - self.odom.stamp))
        dx, dy = share * (odom.pose.x - self.odom.pose.x), share * (odom.pose.y - self.odom.pose.y)
        duration = max(0, odom.stamp - self.time) / SECOND      # less than elapsed if the gyro was used alone
        turned = wrap_angle(odom.pose.yaw - self.odom.pose.yaw)
        gyro, missing = self._gyro_turn(odom.stamp)
        if self.standstill.rests(odom.stamp, odom.pose) and gyro and self.time == self.odom.stamp:
            self.filter.rest(duration)
            self.standstill.add(Part(duration, *gyro), self.filter)
            self.odom_yaw = self.filter.state[YAW]
            self._finish(odom.stamp, odom)
            return
        if self.standstill.case:
            self._leave_standstill()
        wheels = None
        if self.time == self.odom.stamp:
            wheels = turned, odom.angular_variance * elapsed ** 2
        elif duration and not gyro:
            # the gyro was used alone, but not up to here: the wheels measured the rest of the turn
            already = (self.filter.state[YAW] - self.odom_yaw) / (1 - self.filter.state[TURNING])
            wheels = wrap_angle(turned - already), odom.angular_variance * elapsed ** 2
        turn = self.filter.turn(duration, wheels, gyro, hypot(dx, dy), missing)
        if wheels and gyro:
            self._check_agreement(wheels[0], (gyro[0], gyro[1] + missing), hypot(dx, dy), duration)

        # the displacement in the wheels' heading half way
        heading = self.odom.pose.yaw + turned / 2
        c, s = cos(heading), sin(heading)
        forward, left = dx * c + dy * s, dy * c - dx * s
        # that heading in the filter's frame: half way between the yaws at the last odometry and at this one
        yaw = self.filter.state[YAW]
        end = yaw + turn.angle if odom.stamp >= self.time else self._past_yaw(odom.stamp)
        ahead = turned + wrap_angle(end - self.odom_yaw - turned)
        self.filter.move(duration, turn, self.odom_yaw + ahead / 2 - yaw - turn.angle / 2, forward, left,
                         odom.linear_variance * elapsed ** 2)
        self.odom_yaw = end
        self._finish(max(odom.stamp, self.time), odom)

    def _leave_standstill(self):
        """The last moment at rest, in which the robot may have begun to turn, is a turn that the gyro measured."""
        last, ekf = self.standstill.leave(self.filter), self.filter
        if last.time:
            before = ekf.state[YAW]
            ekf.move(last.time, ekf.turn(last.time, None, last[1:]))
            self.odom_yaw += ekf.state[YAW] - before

    def _check_agreement(self, wheels, gyro, travelled, duration):
        """Warn where wheels and gyro contradict what the filter believes, or each other."""
        ekf = self.filter
        sums = ekf.agreement
        if not sums.add(wheels, gyro[0] - ekf.state[BIAS] * duration, gyro[1], travelled, duration):
            return
        measured = f'odom turned by {sums.wheels:.2f} rad, imu_data by {sums.gyro:.2f} rad'
        if ekf.doubt_heading():
            if not self.contradicts:
                self.warn(f'{measured}: one of them is wrong; the heading is uncertain')
            self.contradicted = self.time
        elif not self.another_floor and ekf.doubt_floor():
            self.another_floor = True
            self.warn('%s: this is another floor than the one that the filter started with; the distance is less '
                      'certain'
                      % measured)

    def _step_by_gyro(self, end):
        duration = (end - self.time) / SECOND
        if duration > 0:
            if self.placed and end > self.placed[0]:
                self._place()
            gyro, missing = self._gyro_turn(end)
            if not gyro:    # the wheels will measure this turn
                return
            if self.standstill.case:
                self._leave_standstill()
            if not self.yaws:
                self.yaws.append((self.time, self.filter.state[YAW]))
            self.filter.move(duration, self.filter.turn(duration, None, gyro, missing=missing))
            self._finish(end, None)
            self.yaws.append((end, self.filter.state[YAW]))

    def _place(self):
        """Put the filter where set_pose() has said."""
        (self.placed_at, pose, covariance), self.placed = self.placed, None
        turned = pose.yaw - self.filter.state[YAW]
        self.filter.place(pose, covariance)
        self.odom_yaw += turned
        self.yaws = deque((stamp, yaw + turned) for stamp, yaw in self.yaws)

    def _past_yaw(self, stamp):
        """The filter's yaw at the stamp (ns) of odometry that is behind the gyro."""
        yaws = self.yaws
        while yaws[1][0] < stamp:
            yaws.popleft()
        (start, before), (end, after) = yaws[0], yaws[1]
        return before + (after - before) * (stamp - start) / (end - start)

    def _gyro_turn(self, end):
        """(angle, variance) of the readings up to `end` (ns), None if they do not cover all of that time; and the
        additional variance because readings were lost, if the whole gap is within that time."""
        angle = variance = missing = 0.0
        time, good, density = self.time, True, self.standstill.max_density
        while self.readings and time < end:
            start, imu, changed, lost = self.readings[0]
            if imu.stamp > time:
                good = good and start <= time and abs(imu.rate) < self.prior.gyro_measurement_range
                stop = min(imu.stamp, end)
                part = (stop - time) / SECOND
                angle += imu.rate * part
                whole = (imu.stamp - start) / SECOND
                square = part * whole
                variance += (min(imu.variance, density / whole) + changed) * square
                if start == time and stop == imu.stamp:
                    missing += lost * square
                else:
                    variance += lost * square
                time = stop
            if imu.stamp <= end:
                self.readings.popleft()
        return ((angle, variance), missing) if good and time == end and variance else (None, 0.0)

    def _finish(self, time, odom):
        """Store the result of a step."""
        self.time = time
        state = self.filter.state
        if odom:
            self.odom = odom
            if odom.stamp >= time:
                self.yaws.clear()
        covariance = self.filter.covariance
        if time > self.odom.stamp:
            unknown_travel = DROPOUT_SPEED * (time - self.odom.stamp) / SECOND
            covariance[X, X] += unknown_travel ** 2
            covariance[Y, Y] += unknown_travel ** 2
        self.estimate = Estimate(time, Pose(*state[:3]), covariance, self.odom)
