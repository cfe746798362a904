"""What the filter, robot_pose_ekf's arithmetic and dead reckoning make of the messages of a run; without ROS.

A record has the messages in the order of their stamps (ns): odom: (Odom, variances of its pose's x, y (m^2) and yaw
(rad^2)); imu: (Imu, (yaw, variance) of its orientation).
"""
import math

import numpy

from robot_pose_ekf import RobotPoseEkf
from rbx1_nav.base.messages import yaw_of
from rbx1_nav.base.units import SECOND
from rbx1_nav.filter.combined_odometry import CombinedOdometry
from rbx1_nav.filter.conversions import from_imu, from_odometry
from rbx1_nav.filter.imu_mounting import GyroInput


def odometry(messages):
    """The `odom` of a record, from Odometry messages."""
    return [(from_odometry(message), tuple(message.pose.covariance[index] for index in (0, 7, 35)))
            for message in messages]


def gyro(messages):
    """The `imu` of a record, from Imu messages. The vertical axis is the mean up direction of the orientations."""
    x, y, z, w = numpy.array([[getattr(message.orientation, name) for name in 'xyzw'] for message in messages]).T
    up = numpy.array([2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)]).mean(1)
    vertical = tuple((up / numpy.linalg.norm(up)).tolist())
    gyro_input, readings = GyroInput(), []
    for message in messages:
        data = from_imu(message)
        readings.append((gyro_input.read(data, vertical), (yaw_of(message.orientation), data.yaw_variance)))
        gyro_input.accepted(data)
    return readings


def replay(record, prior, start, end=math.inf, warn=lambda text: None):
    """{stamp: Estimate} of a filter that receives its first odometry at `start`, and all messages up to `end`."""
    combined = CombinedOdometry(prior, SECOND, warn=warn)
    # the interval of the next reading starts at the reading before the first odometry
    messages = [(imu.stamp, 0, imu) for imu, _ in record.imu if start - SECOND <= imu.stamp <= end]
    messages += [(odom.stamp, 1, odom) for odom, _ in record.odom if start <= odom.stamp <= end]
    estimates = {}
    for stamp, kind, message in sorted(messages, key=lambda each: each[:2]):
        if kind:
            combined.add_odom(stamp, message)
        else:
            combined.add_imu(stamp, message)
        if combined.estimate:
            estimates.setdefault(combined.estimate.stamp, combined.estimate)
    return estimates


def at_odometry(record, values):
    """The values of the IMU messages, interpolated at the stamps of the odometry, as in robot_pose_ekf."""
    return numpy.interp([odom.stamp for odom, _ in record.odom], [imu.stamp for imu, _ in record.imu], values)


def run_port(record, start=0, end=math.inf):
    """The poses of robot_pose_ekf's arithmetic from the stamp `start` to `end`."""
    port, poses = RobotPoseEkf(), []
    yaws, variances = numpy.transpose([orientation for _, orientation in record.imu])
    orientations = zip(at_odometry(record, numpy.unwrap(yaws)), at_odometry(record, variances))
    for (odom, pose_variances), orientation in zip(record.odom, orientations):
        if start <= odom.stamp <= end:
            port.update(odom.stamp / SECOND, odom.pose, pose_variances, *orientation)
            poses.append(port.state)
    return poses


def reckon(record, rest, start=0):
    """The poses of dead reckoning from an Odom on: wheel distance along the gyro heading. The mean gyro rate between
    the two stamps of `rest` is subtracted before the integration."""
    stamps, rates = numpy.array([(imu.stamp, imu.rate) for imu, _ in record.imu]).T
    # the first reading is for the time since 0
    durations = numpy.diff(stamps, prepend=stamps[0] if record.odom[0][0].stamp else 0.0) / SECOND
    resting = (stamps > rest[0]) & (stamps <= rest[1])
    bias = numpy.average(rates[resting], weights=durations[resting]) if resting.any() else 0.0
    yaws = at_odometry(record, numpy.cumsum((rates - bias) * durations))[start:]
    x, y, yaw = numpy.array([odom.pose for odom, _ in record.odom[start:]]).T
    yaw = numpy.unwrap(yaw)
    yaws += yaw[0] - yaws[0]
    reported, turned = (each[:-1] + numpy.diff(each) / 2 for each in (yaw, yaws))
    forward = numpy.diff(x) * numpy.cos(reported) + numpy.diff(y) * numpy.sin(reported)
    x, y = (numpy.cumsum([first, *forward * f(turned)]) for first, f in ((x[0], numpy.cos), (y[0], numpy.sin)))
    return numpy.stack([x, y, yaws], axis=1)


def textbook(record, start=0):
    """The yaws of a textbook filter at each Odom from one on, without any rest: bias (1 degree/s) and slip (0.3) are
    states, and each 0.5 s the turn of the wheels is a measurement, with the noise of the lab floor, which counts less
    beyond 3 standard deviations. It does not correct the past."""
    turns = at_odometry(record, numpy.cumsum([imu.rate * (imu.stamp - before) / SECOND for (imu, _), before in zip(
        record.imu, [record.imu[0][0].stamp, *(imu.stamp for imu, _ in record.imu)])]))[start:]
    odoms = [odom for odom, _ in record.odom[start:]]
    state, covariance = numpy.zeros(2), numpy.diag([math.radians(1.0), 0.3]) ** 2
    yaws, begin = [odoms[0].pose.yaw], 0
    for index in range(1, len(odoms)):
        seconds = (odoms[index].stamp - odoms[index - 1].stamp) / SECOND
        yaws.append(yaws[-1] + turns[index] - turns[index - 1] - state[0] * seconds)
        time = (odoms[index].stamp - odoms[begin].stamp) / SECOND
        if time < 0.5:
            continue
        first, last = odoms[begin].pose, odoms[index].pose
        wheels = sum(math.remainder(odoms[i].pose.yaw - odoms[i - 1].pose.yaw, 2 * math.pi)
                     for i in range(begin + 1, index + 1))
        path = math.hypot(last.x - first.x, last.y - first.y)
        derivatives = numpy.array([time, -wheels])
        difference = turns[index] - turns[begin] - wheels - derivatives @ state
        known, noise = derivatives @ covariance @ derivatives, 1e-6 + 0.084 ** 2 * abs(wheels) + 0.066 ** 2 * path
        noise *= max(1.0, difference ** 2 / (known + noise) / 9)
        gain = covariance @ derivatives / (known + noise)
        state = state + gain * difference
        covariance = covariance - numpy.outer(gain, derivatives @ covariance)
        begin = index
    return yaws
