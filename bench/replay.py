"""The figures of a recorded run: the live filter, the replayed filter, and the port of robot_pose_ekf; without ROS.

Stamps are in ns, poses are (x, y, yaw) in m and rad; angles in the results are in degrees.
"""
from collections import namedtuple
import math
import re

from floors import consistency, squared_errors
from rbx1_nav.base.units import SECOND
from rbx1_nav.filter.combined_odometry import CombinedOdometry
from robot_pose_ekf import RobotPoseEkf

STILL = 1e-3        # m and rad: odometry has moved if it differs by more than this from a pose at rest
STANDSTILL = 2 * SECOND     # ns; errors count from this time before the first motion to this time after the last one
DIFFERENCE = 1e-6   # m and rad: a larger difference is not rounding
LIMITS = dict(difference_m=0.001, difference_deg=0.1, nees=(1, 5))
MORE = re.compile(r'\(and (\d+) more of this kind\)')

Recording = namedtuple('Recording', 'odom imu truth combined statistics missing lines')
Recording.__doc__ = """The contents of a bag: odom: (Odom, variances of its pose); imu: (Imu, (yaw, variance) of its
orientation); truth: {stamp: pose}; combined: Published; statistics: (first stamp, last stamp, number of gaps) of the
filter's subscriptions, as rospy counts them; missing: by topic, (stamp after the gap, number of messages) that the
recorder did not receive; lines: log lines of the filter in /rosout."""

Published = namedtuple('Published', 'stamp pose yaw_variance')
Published.__doc__ = 'A published estimate: stamp, pose, variance of the yaw (rad^2).'


class Unusable(Exception):
    """A recording that cannot be evaluated; the text gives the reason."""


def pose_variances(message):
    """The variances of x, y and yaw of an Odometry message."""
    return tuple(message.pose.covariance[index] for index in (0, 7, 35))


def gaps(headers):
    """(stamp after the gap, number of missing messages), from (sequence number, stamp) of the received messages."""
    return [(stamp, number - before - 1) for (before, _), (number, stamp) in zip(headers, headers[1:])
            if number != before + 1]


def count_lines(lines):
    """{what: number of lines} about sensor timeouts, recoveries, and rejected messages."""
    counts = {}
    for what, text in ('timed_out', 'has timed out'), ('recovered', 'has recovered'), ('rejected', '; rejected'):
        found = [line for line in lines if text in line]
        counts[what] = len(found) + sum(int(more.group(1)) for more in map(MORE.search, found) if more)
    return counts


def replay(recording, prior, start, end=math.inf, warn=lambda text: None):
    """{stamp: Estimate} of a filter that receives its first odometry at `start`, and all messages up to `end`."""
    combined = CombinedOdometry(prior, SECOND, warn=warn)
    # the interval of the next reading starts at the reading before the first odometry
    messages = [(imu.stamp, 0, imu) for imu, _ in recording.imu if start - SECOND <= imu.stamp <= end]
    messages += [(odom.stamp, 1, (odom, variances)) for odom, variances in recording.odom if start <= odom.stamp <= end]
    estimates = {}
    for stamp, kind, message in sorted(messages, key=lambda each: each[:2]):
        if kind:
            combined.add_odom(stamp, message[0])
        else:
            combined.add_imu(stamp, message)
        if combined.estimate:
            estimates.setdefault(combined.estimate.stamp, combined.estimate)
    return estimates


def replay_port(recording, start, end):
    """The pose of robot_pose_ekf's arithmetic at `end`."""
    port, orientations = RobotPoseEkf(), {imu.stamp: orientation for imu, orientation in recording.imu}
    for odom, variances in recording.odom:
        if start <= odom.stamp <= end and odom.stamp in orientations:
            port.update(odom.stamp / SECOND, odom.pose, variances, *orientations[odom.stamp])
    return tuple(port.state)


def find_start(recording, prior):
    """The stamp of the first odometry that the filter received. Raises Unusable.

    How small the variance of the yaw is at the first published estimate depends on the number of steps until then.
    """
    first = recording.combined[0]
    starts = [odom.stamp for odom, _ in recording.odom if first.stamp - SECOND < odom.stamp <= first.stamp]
    if not starts:
        raise Unusable('no odometry was recorded at the start of the filter')

    def deviation(start):
        estimate = replay(recording, prior, start, first.stamp).get(first.stamp)
        return abs(estimate.covariance[2, 2] - first.yaw_variance) if estimate else math.inf
    return min(starts, key=deviation)


def motion(odom):
    """The stamps between which odometry moves. odom: Odoms. Raises Unusable."""
    def moved(pose, other):
        return max(abs(a - b) for a, b in zip(pose, other)) > STILL
    stamps = [each.stamp for each in odom if moved(each.pose, odom[0].pose) and moved(each.pose, odom[-1].pose)]
    if not stamps:
        raise Unusable('the robot did not move')
    return stamps[0], stamps[-1]


def is_scheduled(published, stamps, period):
    """Whether a filter with estimates at `stamps` publishes exactly `published`, one per `period` (ns).

    From some start time on, it publishes the first estimate at or after each multiple of the period. Each published
    estimate therefore limits the start time: not before the last unpublished estimate, and not after the published one.
    """
    earlier = dict(zip(stamps[1:], stamps))
    low, high = -math.inf, math.inf
    for before, stamp in zip([published[0], *published], published):
        if stamp not in earlier or stamp - before >= 2 * period:
            return False
        grid = round((stamp - published[0]) / period) * period
        low, high = max(low, earlier[stamp] - grid), min(high, stamp - grid)
    return low < high


def difference(pose, other):
    """(m, degrees) between two poses."""
    heading, position = squared_errors(pose, other)
    return math.sqrt(position), math.sqrt(heading)


def exercise(recording):
    """The stamps from STANDSTILL before the first motion to STANDSTILL after the last one. Raises Unusable."""
    begin, end = motion([odom for odom, _ in recording.odom])
    begin, end = begin - STANDSTILL, end + STANDSTILL
    stamps = [odom.stamp for odom, _ in recording.odom]
    if stamps[0] > begin or stamps[-1] < end:
        raise Unusable(f'the robot was stationary for less than {STANDSTILL / SECOND:g} s before or after its motion')
    return begin, end


def live_figures(recording, prior, period):
    """The reports of the live filter, whether it received the recorded messages, and its difference from the replay,
    from its start to the end of the exercise. period: publishing period, ns. Raises Unusable."""
    start, (begin, end) = find_start(recording, prior), exercise(recording)
    if start > begin:
        raise Unusable(f'the filter was started less than {STANDSTILL / SECOND:g} s before the motion')
    estimates = replay(recording, prior, start, end)
    # the gyro may be ahead at the start: the first published estimate differs
    published = [each for each in recording.combined if start + SECOND < each.stamp <= end]
    if not published:
        raise Unusable('no odom_combined during the exercise')
    common = [each for each in published if each.stamp in estimates]
    differences = [(each.stamp, *difference(each.pose, estimates[each.stamp].pose)) for each in common]
    row = dict(replayed_s=(end - start) / SECOND,
               missing={topic: sum(number for stamp, number in those if start < stamp <= end)
                        for topic, those in recording.missing.items()},
               dropped=sum(number for since, until, number in recording.statistics if since <= end and until >= start),
               scheduled=is_scheduled([each.stamp for each in published], list(estimates), period),
               differs_after_s=next(((stamp - start) / SECOND for stamp, metres, degrees in differences
                                     if metres > DIFFERENCE or math.radians(degrees) > DIFFERENCE), None),
               **count_lines(recording.lines))
    row['same'] = row['scheduled'] and not row['dropped'] and not any(
        row['missing'].get(topic) for topic in ('/odom', '/imu/data', '/odom_combined'))
    row['difference_m'], row['difference_deg'] = differences[-1][1:] if differences else (math.nan, math.nan)
    return row


def end_figures(recording, prior):
    """The errors of a replay and of the port against the truth, from one standstill to the other. Raises Unusable."""
    begin, end = exercise(recording)
    estimates = replay(recording, prior, begin, end)
    last = max((stamp for stamp in estimates if stamp in recording.truth), default=None)
    if last is None:
        raise Unusable('no ground truth')
    first, truth, estimate = min(estimates), recording.truth[last], estimates[last]
    metres, degrees = difference(estimate.pose, truth)
    port_metres, port_degrees = difference(replay_port(recording, first, last), truth)
    return dict(error_m=metres, error_deg=degrees, port_m=port_metres,
                port_deg=port_degrees, nees=consistency(estimate.pose, truth, estimate.covariance))


def means(rows):
    """The mean of each figure of end_figures() over the runs."""
    names = 'error_m', 'error_deg', 'port_m', 'port_deg', 'nees'
    return {name: sum(row[name] for row in rows) / len(rows) for name in names}


def misses(rows):
    """The figures beyond the limits, as text."""
    found = []
    for row in rows:
        lines = sum(row[name] for name in ('timed_out', 'recovered', 'rejected'))
        if lines:
            found.append('seed %d: %d lines about dropouts and rejected messages' % (row['seed'], lines))
        # not `>`: a missing difference (NaN) is a miss
        if row['same'] and not all(row[name] <= LIMITS[name] for name in ('difference_m', 'difference_deg')):
            found.append('seed %d: the same messages, but %.2g m and %.2g degrees from the replay'
                         % (row['seed'], row['difference_m'], row['difference_deg']))
    mean = means(rows)
    for name, port in ('error_m', 'port_m'), ('error_deg', 'port_deg'):
        if not mean[name] <= mean[port]:
            found.append(f'mean {name}: {mean[name]:.3g}, the port {mean[port]:.3g}')
    least, greatest = LIMITS['nees']
    if not least <= mean['nees'] <= greatest:
        found.append(f"mean NEES: {mean['nees']:.3g}: expected {least:g} to {greatest:g}")
    return found
