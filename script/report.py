#!/usr/bin/python3
"""Prints the end poses of a recorded run, and draws the run as arrows: report.py BAG PICTURE [SURFACE]"""
import sys
from math import atan2, cos, degrees, hypot, pi, sin

import matplotlib
import rosbag
from nav_msgs.msg import Odometry

from rbx1_nav.extras.many_runs.plots import ESTIMATE, ODOMETRY, TRUTH

matplotlib.use('Agg')
from matplotlib import pyplot       # noqa: E402  (the backend comes first)

SPACING, TURN = 0.1, 0.15       # m and rad between two arrows, as in sim.rviz
# in drawing order, with the truth last, on top
TOPICS = {'/odom': ('odometry', ODOMETRY), '/odom_ekf': ('estimate from wheels and gyro', ESTIMATE),
          '/ground_truth': ('truth', TRUTH)}

# otherwise rosbag generates the class, as Python code, from the message definition in the bag, which may be untrusted
rosbag.bag._message_types[Odometry._md5sum] = Odometry


def read_paths(bag):
    """Return all (x, y, yaw) by topic, for each of TOPICS that was recorded: m and rad, the yaw not wrapped."""
    paths = {}
    with rosbag.Bag(bag) as file:
        for topic, message, _ in file.read_messages(list(TOPICS), connection_filter=is_odometry):
            path = paths.setdefault(topic, [])
            pose = message.pose.pose
            yaw = 2 * atan2(pose.orientation.z, pose.orientation.w)
            if path:
                yaw += 2 * pi * round((path[-1][2] - yaw) / (2 * pi))
            path.append((pose.position.x, pose.position.y, yaw))
    return {topic: paths[topic] for topic in TOPICS if topic in paths}


def is_odometry(_topic, _datatype, md5sum, *_):
    """Return whether a connection of a bag contains Odometry messages."""
    return md5sum == Odometry._md5sum


def arrows(path):
    """Return the poses that are far enough from the previously drawn pose to be drawn as an arrow."""
    chosen = path[:1]
    for x, y, yaw in path:
        if hypot(x - chosen[-1][0], y - chosen[-1][1]) >= SPACING or abs(yaw - chosen[-1][2]) >= TURN:
            chosen.append((x, y, yaw))
    return chosen


def draw(paths, picture, surface):
    """Draw the arrows, seen from above, and the true start and end positions."""
    figure, axes = pyplot.subplots(figsize=(9, 6.5))
    for topic, path in paths.items():
        name, color = TOPICS[topic]
        x, y, yaw = zip(*arrows(path))
        axes.quiver(x, y, [cos(a) for a in yaw], [sin(a) for a in yaw], color=color, label=name, angles='xy',
                    scale_units='xy', scale=1 / 0.3, width=0.003)
    start, end = path[0], path[-1]
    axes.plot(*start[:2], 'o', color='black', markersize=9, label='start')
    axes.plot(*end[:2], 's', color='black', markerfacecolor='white', markersize=9, label='end')
    points = [point for path in paths.values() for point in path]
    for axis, index, low, high in (('x', 0, -0.5, 1.5), ('y', 1, -0.6, 0.9)):
        values = [point[index] for point in points]
        axes.set(**{f'{axis}lim': (min(low, min(values) - 0.4), max(high, max(values) + 0.4))})
    axes.set(title=f'Out and back on {surface}', xlabel='x (m)', ylabel='y (m)', aspect='equal')
    axes.grid(True)
    axes.legend(loc='upper center', bbox_to_anchor=(0.5, -0.1), ncol=5, frameon=False)
    figure.savefig(picture, dpi=100, bbox_inches='tight')


def rounded(value, digits):
    """Return a value rounded to a number of decimals as text, with 0 instead of -0."""
    return '%.*f' % (digits, round(value, digits) + 0.0)


def main(bag, picture, surface='an unknown surface'):
    """Report on one run."""
    paths = read_paths(bag)
    if '/odom' not in paths:
        sys.exit(f'{bag}: no odometry: expected messages on /odom')
    for topic, path in reversed(list(paths.items())):
        (x0, y0, yaw0), (x, y, yaw) = path[0], path[-1]
        print('End pose, %-14s x %s m, y %s m, heading %s degrees; %s m from the start, turned %s degrees' % (
            f'{topic}:', rounded(x, 4), rounded(y, 4), rounded(degrees(atan2(sin(yaw), cos(yaw))), 2),
            rounded(hypot(x - x0, y - y0), 4), rounded(degrees(yaw - yaw0), 2)))
    draw(paths, picture, surface)
    print(f'Bag:     {bag}')
    print(f'Picture: {picture}')


if __name__ == '__main__':
    main(*sys.argv[1:])
