#!/usr/bin/env python3
"""Evaluate the filter on a recorded run against the GPS of the robot. See README.md."""
import argparse
from itertools import accumulate
import math
import sys
from typing import NamedTuple

import numpy
import rosbag

from replay import gyro, odometry, reckon, replay
from rbx1_nav.filter.priors import UNKNOWN_FLOOR

TYPES = 'nav_msgs/Odometry', 'sensor_msgs/Imu', 'sensor_msgs/NavSatFix'
STILL = 0.01        # m/s and rad/s
RADIUS, SQUARED_ECCENTRICITY = 6378137.0, 6.69437999014e-3     # m; of the WGS 84 ellipsoid


class Record(NamedTuple):
    """The contents of a bag, each list in stamp order (ns)."""
    odom: list      # these two: see replay.py
    imu: list
    speeds: list    # (m/s, rad/s) of each Odom
    fixes: list     # (stamp, latitude, longitude in degrees)


def read_record(path, odom, imu, fix):
    """The Record of a bag with these topics. Raises ValueError."""
    found = {odom: [], imu: [], fix: []}
    with rosbag.Bag(path) as bag:
        for topic, message, _ in bag.read_messages(list(found)):
            if message._type == TYPES[list(found).index(topic)]:
                found[topic].append(message)
    for (topic, each), kind in zip(found.items(), TYPES):
        if len(each) < 2:
            raise ValueError(f'{topic}: {len(each)} messages of type {kind}: expected at least 2')
        each.sort(key=lambda message: message.header.stamp)
    twists = [message.twist.twist for message in found[odom]]
    return Record(odometry(found[odom]), gyro(found[imu]),
                  [(twist.linear.x, twist.angular.z) for twist in twists],
                  [(message.header.stamp.to_nsec(), message.latitude, message.longitude) for message in found[fix]])


def local(fixes):
    """(stamps in ns, east and north in m) of the fixes, in the plane tangent to WGS 84 at the first one."""
    stamps, *angles = numpy.array(fixes).T
    (latitude, longitude) = numpy.radians(angles)
    flat = 1 - SQUARED_ECCENTRICITY * math.sin(latitude[0]) ** 2
    east = RADIUS / math.sqrt(flat) * math.cos(latitude[0]) * (longitude - longitude[0])
    north = RADIUS * (1 - SQUARED_ECCENTRICITY) / flat ** 1.5 * (latitude - latitude[0])
    return stamps, numpy.stack([east, north], 1)


def rms_to_gps(stamps, path, gps):
    """The rms distance (m) of a path (n x 2) from the result of local(), after the best rotation and translation
    (Kabsch 1976)."""
    gps_stamps, places = gps
    inside = (gps_stamps >= stamps[0]) & (gps_stamps <= stamps[-1])
    path = numpy.stack([numpy.interp(gps_stamps[inside], stamps, each) for each in numpy.transpose(path)], 1)
    path, places = path - path.mean(0), places[inside] - places[inside].mean(0)
    u, _, v = numpy.linalg.svd(path.T @ places)
    rotation = u @ numpy.diag([1.0, numpy.linalg.det(u @ v)]) @ v
    return math.sqrt(numpy.mean(numpy.sum((path @ rotation - places) ** 2, axis=1)))


def longest_rest(record):
    """(first, last) stamp of the longest interval in which the wheels report no motion."""
    still = [max(map(abs, speeds)) < STILL for speeds in record.speeds]
    since = accumulate(range(len(still)), lambda start, index: start if still[index - 1] and still[index] else index)
    first, last = max(((start, index) for index, start in enumerate(since) if still[index]),
                      key=lambda rest: record.odom[rest[1]][0].stamp - record.odom[rest[0]][0].stamp, default=(0, 0))
    return record.odom[first][0].stamp, record.odom[last][0].stamp


def judge(record):
    """A dict: rms distances from the GPS (m), and the final uncertainty of the filter (1 sigma, m and rad)."""
    stamps, gps = [odom.stamp for odom, _ in record.odom], local(record.fixes)
    if not stamps[0] <= gps[0][-1] or not gps[0][0] <= stamps[-1]:
        raise ValueError('the odometry and the GPS do not overlap in time')
    estimates = replay(record, UNKNOWN_FLOOR, stamps[0])
    last = estimates[max(estimates)]
    return dict(
        filter=rms_to_gps(sorted(estimates), [estimates[stamp].pose[:2] for stamp in sorted(estimates)], gps),
        wheels=rms_to_gps(stamps, [odom.pose[:2] for odom, _ in record.odom], gps),
        reckoned=rms_to_gps(stamps, reckon(record, longest_rest(record))[:, :2], gps),
        position_sigma=math.sqrt(numpy.linalg.eigvalsh([row[:2] for row in last.covariance[:2]])[-1]),
        yaw_sigma=math.sqrt(last.covariance[2][2]))


def main():
    """Read the bag and print. Returns the exit status."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument('bag')
    for name, topic, kind in zip(('--odom', '--imu', '--fix'), ('/odom', '/imu/data', '/fix'), TYPES):
        parser.add_argument(name, metavar='TOPIC', default=topic, help=f'{kind}; default: {topic}')
    arguments = parser.parse_args()
    try:
        figures = judge(read_record(arguments.bag, arguments.odom, arguments.imu, arguments.fix))
    except (OSError, ValueError, rosbag.ROSBagException) as error:
        print(f"{arguments.bag}: {getattr(error, 'strerror', None) or error}", file=sys.stderr)
        return 1
    print('rms distance from the GPS: filter %(filter).2f m, wheels %(wheels).2f m, wheels with the gyro '
          '%(reckoned).2f m\nfinal uncertainty of the filter (1 sigma): %(position_sigma).1f m, %(yaw_sigma).3f rad'
          % figures)
    return 0


if __name__ == '__main__':
    sys.exit(main())
