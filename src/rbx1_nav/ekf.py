"""Combined odometry: a planar extended Kalman filter of wheel odometry and a gyro.

Both sensors tell the same turn, each with errors of its own that stay what they are for a run: the wheels slip by a part
of their travel, the gyro has a bias and a scale error. So these four are part of the state, beside the pose:

    x, y (m), yaw (rad), gyro bias (rad/s), gyro scale error, slip straight, slip turning (parts of the travel),
    rounding (m): what the wheels' last report of travel was too long by, for their next one makes up for it

In each step the wheels report a turn W, of which W (1 - slip turning) is made, and the gyro's rates add up to G, of which
(G - bias * time) / (1 + scale error) is made. Their difference, which should be 0, is a measurement of the errors; their
mean, each weighted by the other's noise, is the turn. The noise of that mean and the noise of the difference are
uncorrelated (the Gauss-Markov theorem), so to use the two one after the other loses nothing and counts nothing twice.
The rest is the textbook's filter: Thrun, Burgard and Fox, Probabilistic Robotics, section 3.3.
"""
from collections import namedtuple, deque
from math import cos, hypot, inf, pi, radians, remainder, sin

import numpy

from rbx1_nav.base import SECOND
from rbx1_nav.diff_drive import Pose
from rbx1_nav.wheels import LEAST_VARIANCE

X, Y, YAW, BIAS, SCALE, STRAIGHT, TURNING, ROUNDING = range(8)

START = 1e-9                # variance of the first pose, m^2 and rad^2: the frame begins where the robot does
BIAS_WALK = radians(0.002)  # rad/s for each root of a second: no gyro's bias is constant for ever; 0.5 deg/s in 17 hours
OUTLIER = 5.0               # standard deviations between wheels and gyro, from which on one of them must be wrong

MOST = 1e6              # m or rad/s that a message may tell
MOST_SPEED = 2.0        # m/s: odometry that moves faster has jumped
MOST_TURN = 5.0         # rad/s: or turns faster
SLACK = 0.02            # m and rad that it may be off besides
UNSEEN_SPEED = 0.5      # m/s: so fast may a robot go (1 sigma) while no odometry comes
FUTURE = SECOND // 2    # ns that a stamp may be ahead of our clock: clocks differ
PAST = 10 * SECOND      # ns that it may be behind

Priors = namedtuple('Priors', 'slip_straight slip_straight_spread slip_turning slip_turning_spread '
                              'gyro_bias gyro_scale_error gyro_measurement_range')
Priors.__doc__ = 'What is taken for granted before the first message; the fields of a Surface, in its units.'


def priors(surface):
    """The Priors of a Surface (None: the ideal one)."""
    if surface is None:
        return Priors(0.0, 0.0, 0.0, 0.0, 0.0, 0.0, inf)
    return Priors(*(getattr(surface, field) for field in Priors._fields))


Turn = namedtuple('Turn', 'angle variance by_bias by_scale by_slip')
Turn.__doc__ = "A turn (rad), its variance (rad^2), and its derivatives by the gyro's bias and scale error and the slip."


class RefusedMessage(ValueError):
    """A message that the filter must not see. The text names the field, the value and what is expected."""


class Filter:
    """The arithmetic. Knows nothing of time stamps, lost messages or bad ones."""

    def __init__(self, prior, pose):
        """prior: Priors; pose: the first one."""
        self.state = [pose.x, pose.y, pose.yaw, 0.0, 0.0, prior.slip_straight, prior.slip_turning,
                      0.0]
        self.covariance = numpy.diag([START, START, START, prior.gyro_bias ** 2, prior.gyro_scale_error ** 2,
                                      prior.slip_straight_spread ** 2, prior.slip_turning_spread ** 2, 0.0])
        self.outliers = 0   # steps in which wheels and gyro contradicted each other

    def turn(self, duration, wheels=None, gyro=None):
        """Make a Turn for move() of what the sensors tell of a step of `duration` (s), and learn from it.

        wheels, gyro: (angle in rad, its variance in rad^2) as each of them tells it, or None. Where both do, and
        contradict each other by OUTLIER, the wheels have slipped like never before, and the gyro is believed.
        """
        both = self._compare(duration, wheels, gyro) if wheels and gyro else None
        if both:
            return both
        if gyro:
            scale = 1 + self.state[SCALE]
            angle = (gyro[0] - self.state[BIAS] * duration) / scale
            return Turn(angle, gyro[1] / scale ** 2, -duration / scale, -angle / scale, 0.0)
        if wheels:
            made = 1 - self.state[TURNING]
            return Turn(wheels[0] * made, wheels[1] * made ** 2, 0.0, 0.0, -wheels[0])
        return Turn(0.0, 0.0, 0.0, 0.0, 0.0)

    def _compare(self, duration, wheels, gyro):
        """The difference as a measurement, then the mean; None where they contradict each other."""
        state, covariance = self.state, self.covariance
        scale, made = 1 + state[SCALE], 1 - state[TURNING]
        wheel_noise, gyro_noise = wheels[1] * made ** 2, gyro[1] / scale ** 2
        angle = (gyro[0] - state[BIAS] * duration) / scale
        difference = wheels[0] * made - angle
        # the wheels' turn is taken from the gyro here: their own is rounded to ticks, and a noise that is in a
        # measurement and in its derivative too does not average out
        by_bias, by_scale, by_slip = duration / scale, angle / scale, -angle / made
        columns = by_bias * covariance[BIAS] + by_scale * covariance[SCALE] + by_slip * covariance[TURNING]
        _, _, _, bias, scale_error, _, slip, _ = columns.tolist()
        variance = (by_bias * bias + by_scale * scale_error + by_slip * slip) + wheel_noise + gyro_noise
        if difference ** 2 > OUTLIER ** 2 * variance:
            self.outliers += 1
            return None
        gain = columns / variance
        self.state = [old - change * difference for old, change in zip(state, gain.tolist())]
        covariance -= gain[:, None] * columns

        scale, made = 1 + self.state[SCALE], 1 - self.state[TURNING]
        angle = (gyro[0] - self.state[BIAS] * duration) / scale
        share = gyro_noise / (gyro_noise + wheel_noise)     # of the wheels
        return Turn(share * wheels[0] * made + (1 - share) * angle, share * wheel_noise,
                    (share - 1) * duration / scale, (share - 1) * angle / scale, -share * wheels[0])

    def move(self, duration, turn, direction=0.0, forward=0.0, left=0.0, variance=0.0):
        """Make a step of `duration` (s): a Turn of turn()'s, and travel.

        forward, left: displacement (m) as the wheels tell it, in a frame that is turned against the robot's half way
        through the turn by `direction` (rad); variance: of the displacement, m^2.
        """
        angle, noise, by_bias, by_scale, by_slip = turn
        x, y, yaw, bias, scale, straight, turning, rounding = self.state
        middle = yaw + angle / 2 + direction
        c, s = cos(middle), sin(middle)
        made = 1 - straight
        moved = bool(forward or left)       # wheels that count nothing have nothing to make up for
        if moved:
            forward, rounding = forward + rounding, 0.0
        along, across = forward * c - left * s, forward * s + left * c
        self.state = [x + made * along, y + made * across, yaw + angle, bias, scale, straight, turning, rounding]

        # derivatives of x and y by the angle of their middle; half of the turn counts for it
        dx, dy = -made * across, made * along
        jacobian = numpy.array([
            [1.0, 0.0, dx, dx / 2 * by_bias, dx / 2 * by_scale, -along, dx / 2 * by_slip, made * c * moved],
            [0.0, 1.0, dy, dy / 2 * by_bias, dy / 2 * by_scale, -across, dy / 2 * by_slip, made * s * moved],
            [0.0, 0.0, 1.0, by_bias, by_scale, 0.0, by_slip, 0.0]])
        covariance = self.covariance
        rows = jacobian @ covariance
        pose = rows @ jacobian.T
        rounded = variance / 2 * moved      # the difference of two roundings has twice the variance of one
        if moved:
            rows[:, ROUNDING] = -made * c * rounded, -made * s * rounded, 0.0
            covariance[ROUNDING] = 0.0
            covariance[ROUNDING, ROUNDING] = rounded
        covariance[:3] = rows
        covariance[:, :3] = rows.T
        dx, dy, c, s = dx / 2, dy / 2, made * c, made * s
        covariance[:3, :3] = pose + numpy.array([
            [dx * dx * noise + c * c * rounded, dx * dy * noise + c * s * rounded, dx * noise],
            [dx * dy * noise + c * s * rounded, dy * dy * noise + s * s * rounded, dy * noise],
            [dx * noise, dy * noise, noise]])
        covariance[BIAS, BIAS] += BIAS_WALK ** 2 * duration


Odom = namedtuple('Odom', 'stamp pose linear_variance angular_variance')
Odom.__doc__ = "Wheel odometry: stamp in ns, Pose in its frame, variances of its speeds (m^2/s^2, rad^2/s^2)."

Imu = namedtuple('Imu', 'stamp rate variance')
Imu.__doc__ = 'A reading: stamp in ns, mean angular velocity since the one before (rad/s), its variance (rad^2/s^2).'

Estimate = namedtuple('Estimate', 'stamp pose covariance odom')
Estimate.__doc__ = """What is known: stamp in ns, Pose, 3x3 covariance of x, y (m) and yaw (rad), and the Odom that it goes
with, the last one."""


def wrapped(angle):
    """The same angle between -pi and pi, rad."""
    return remainder(angle, 2 * pi)


def check(field, value, good, expected):
    """Raises RefusedMessage where a value is not good."""
    if not good:
        raise RefusedMessage('%s: %s: expected %s' % (field, value, expected))


def check_number(field, value):
    """Raises RefusedMessage where a number is none, or so big that sums lose what is small."""
    check(field, value, abs(value) <= MOST, 'a number of at most %g' % MOST)


def check_variance(field, value):
    """Raises RefusedMessage where a variance is 0, none, or so small or big that dividing by it means nothing."""
    check(field, value, LEAST_VARIANCE <= value <= 1 / LEAST_VARIANCE, 'a variance above 0, from %g to %g'
          % (LEAST_VARIANCE, 1 / LEAST_VARIANCE))


def told(odom):
    """An Odom's pose, for people."""
    return '(%.3f m, %.3f m, %.3f rad)' % odom.pose


def distance(one, other):
    """Between two Odoms, m."""
    return hypot(other.pose.x - one.pose.x, other.pose.y - one.pose.y)


def jumped(before, odom):
    """Whether no robot goes or turns from the one Odom to the other in that time."""
    elapsed = (odom.stamp - before.stamp) / SECOND
    return (distance(before, odom) > MOST_SPEED * elapsed + SLACK
            or abs(wrapped(odom.pose.yaw - before.pose.yaw)) > MOST_TURN * elapsed + SLACK)


class CombinedOdometry:
    """Puts messages in order, and the filter to work: a step from each odometry message to the next.

    Time is in the messages' stamps (ns), so that the result does not depend on when they come. A step waits until the
    gyro has reported up to its end. A sensor that is silent for `timeout` while the other speaks is left out until it
    speaks again: without the gyro the wheels tell the turn; without odometry the gyro does, and nobody tells the way, so
    that the uncertainty of the position grows. What the wheels travelled meanwhile counts when they report again.
    """

    def __init__(self, prior, timeout, gyro_used=True, say=lambda text: None):
        """prior: Priors; timeout: ns; gyro_used: whether to wait for a gyro at all; say(text): tells the reader."""
        self.prior = prior
        self.timeout = timeout
        self.gyro_used = gyro_used
        self.say = say
        self.now = 0
        self.last = {'odom': None, 'imu_data': None}        # ns, stamp of the last message
        self.restart()

    def restart(self, reason=None):
        """Forget everything; the next odometry message tells where to begin."""
        if reason:
            self.say('%s: starting again from where the odometry says' % reason)
        self.filter = None
        self.estimate = None        # the latest Estimate
        self.waiting = deque()      # Odom, until the gyro has caught up
        self.readings = deque()     # (ns at the begin of its time, Imu), not used yet
        self.time = None            # ns, how far the filter is
        self.odom = None            # the last Odom of a step
        self.odom_yaw = None        # rad, the filter's yaw at that time
        self.suspect = None         # an Odom that was too far away to be believed
        self.silent = {'odom': False, 'imu_data': False}    # who is left out

    # what comes in

    def add_odom(self, now, odom, pose_variances):
        """Take an Odom that arrived at `now` (ns). Raises RefusedMessage.

        pose_variances: of x, y (m^2) and yaw (rad^2). They count where the sender has none for its speeds (0): for those
        of a second's travel, which is what robot_pose_ekf takes them for.
        """
        for field, value in zip(('position.x', 'position.y', 'orientation'), odom.pose):
            check_number('pose.pose.' + field, value)
        for index, variance in zip((0, 7, 35), pose_variances):
            check_variance('pose.covariance[%d]' % index, variance)
        for index, variance in ((0, odom.linear_variance), (35, odom.angular_variance)):
            if variance != 0:
                check_variance('twist.covariance[%d]' % index, variance)
        if not (odom.linear_variance and odom.angular_variance):
            odom = odom._replace(linear_variance=pose_variances[0], angular_variance=pose_variances[2])
        self._heard('odom', now, odom.stamp)
        if not self.silent['odom']:
            self.waiting.append(odom)
        self._advance()

    def add_imu(self, now, imu):
        """Take an Imu that arrived at `now` (ns). Raises RefusedMessage."""
        check_number('angular_velocity.z', imu.rate)
        check_variance('angular_velocity_covariance[8]', imu.variance)
        before = self._heard('imu_data', now, imu.stamp)
        # after a silence it tells of a time whose begin nobody knows
        if (self.filter or self.waiting) and before is not None and imu.stamp - before <= self.timeout:
            self.readings.append((before, imu))
        self._advance()

    def _heard(self, sensor, now, stamp):
        """Check a stamp, and keep it; returns the one before, or None."""
        if now < self.now - FUTURE:
            self.restart('The clock went back by %.3f s' % ((self.now - now) / SECOND))
            self.last = {'odom': None, 'imu_data': None}
        self.now = now
        before = self.last[sensor]
        for good, expected, time in ((stamp <= now + FUTURE, 'none later than now', now),
                                     (stamp >= now - PAST, 'none that is much older than now', now),
                                     (before is None or stamp > before, 'one later than the last', before or 0)):
            check('header.stamp', '%.9f' % (stamp / SECOND), good, '%s, %.9f' % (expected, time / SECOND))
        self.last[sensor] = stamp
        other = self.last['odom' if sensor == 'imu_data' else 'imu_data']
        # not if it is as late as when it was left out
        if self.silent[sensor] and (other or 0) - stamp <= self.timeout:
            self.silent[sensor] = False
            self.say('%s is back' % sensor)
        return before

    def _leave_out(self, sensor):
        if not self.silent[sensor]:
            self.silent[sensor] = True
            self.say('%s: no message for more than %g s: left out until it is back' % (sensor, self.timeout / SECOND))

    # what follows from it

    def _advance(self):
        """Make all steps that can be made now."""
        while self.waiting and self._gyro_is_ready():
            self._step(self.waiting.popleft())
        if self.filter and not self.waiting and (self.last['imu_data'] or 0) - self.odom.stamp > self.timeout:
            self._leave_out('odom')
            self._step_by_gyro(self.last['imu_data'])

    def _gyro_is_ready(self):
        """Whether it has reported up to the first odometry that waits, or need not be waited for."""
        first, last, heard = self.waiting[0].stamp, self.waiting[-1].stamp, self.last['imu_data']
        if not self.gyro_used or self.silent['imu_data'] or heard is not None and heard >= first:
            return True
        if last - (first if heard is None else heard) > self.timeout:
            self._leave_out('imu_data')
        return self.silent['imu_data']

    def _step(self, odom):
        if self.odom and odom.stamp <= self.odom.stamp:
            return
        # one message from another place is a mistake; a second one from there is another place
        suspect, self.suspect = self.suspect, None
        if suspect and not jumped(suspect, odom) and distance(suspect, odom) <= distance(self.odom, odom):
            self.restart('odom: jumped from %s to %s' % (told(self.odom), told(odom)))
        elif self.filter and jumped(self.odom, odom):
            self.say('odom: %s comes too soon after %s: ignored' % (told(odom), told(self.odom)))
            self.suspect = odom
            return
        if not self.filter:
            self.filter = Filter(self.prior, odom.pose)
            self._finish(odom.stamp, odom)
            return

        elapsed = (odom.stamp - self.odom.stamp) / SECOND
        across, up = odom.pose.x - self.odom.pose.x, odom.pose.y - self.odom.pose.y
        duration = max(0, odom.stamp - self.time) / SECOND      # less than elapsed where the gyro went on alone
        turned = wrapped(odom.pose.yaw - self.odom.pose.yaw)
        gyro = self._gyro_turn(odom.stamp)
        wheels = None
        if self.time == self.odom.stamp:
            wheels = turned, odom.angular_variance * elapsed ** 2
        elif duration and not gyro:
            # the gyro went on alone, but not as far as this: the rest of the turn is the wheels'
            already = (self.filter.state[YAW] - self.odom_yaw) / (1 - self.filter.state[TURNING])
            wheels = wrapped(turned - already), odom.angular_variance * elapsed ** 2
        turn = self.filter.turn(duration, wheels, gyro)

        # the displacement, seen from the heading that the wheels had half way
        heading = self.odom.pose.yaw + turned / 2
        c, s = cos(heading), sin(heading)
        forward, left = across * c + up * s, up * c - across * s
        # and that heading for us: half way from where we were when the wheels reported last
        since = self.filter.state[YAW] - self.odom_yaw
        ahead = turned + wrapped(since + turn.angle - turned)
        self.filter.move(duration, turn, ahead / 2 - since - turn.angle / 2, forward, left,
                         odom.linear_variance * elapsed ** 2)
        self._finish(max(odom.stamp, self.time), odom)

    def _step_by_gyro(self, end):
        duration = (end - self.time) / SECOND
        if duration > 0:
            self.filter.move(duration, self.filter.turn(duration, None, self._gyro_turn(end)))
            self._finish(end, None)

    def _gyro_turn(self, end):
        """(angle, variance) that the gyro read until `end` (ns); None where it does not know all of it."""
        angle = variance = 0.0
        time, good = self.time, True
        while self.readings and time < end:
            start, imu = self.readings[0]
            if imu.stamp > time:
                good = good and start <= time and abs(imu.rate) < self.prior.gyro_measurement_range
                stop = min(imu.stamp, end)
                part = (stop - time) / SECOND
                angle += imu.rate * part
                variance += imu.variance * part * (imu.stamp - start) / SECOND
                time = stop
            if imu.stamp <= end:
                self.readings.popleft()
        return (angle, variance) if good and time == end and variance else None

    def _finish(self, time, odom):
        """Keep what a step came to."""
        self.time = time
        state = self.filter.state
        if odom:
            self.odom, self.odom_yaw = odom, state[YAW]
        covariance = self.filter.covariance[:3, :3].copy()
        unseen = UNSEEN_SPEED * (time - self.odom.stamp) / SECOND
        covariance[X, X] += unseen ** 2
        covariance[Y, Y] += unseen ** 2
        self.estimate = Estimate(time, Pose(*state[:3]), covariance, self.odom)
