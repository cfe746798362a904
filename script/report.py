#!/usr/bin/python3
"""Prints where a recorded run ended, and draws it as arrows: report.py BAG PICTURE"""
import sys
from math import atan2, cos, degrees, hypot, pi, sin

import matplotlib
import rosbag

matplotlib.use('Agg')
from matplotlib import pyplot       # noqa: E402  (the backend comes first)

SPACING, TURN = 0.1, 0.15       # m and rad between two arrows, as in sim.rviz
TOPICS = {'/ground_truth': ('truth', 'royalblue'), '/odom': ('/odom says', 'firebrick'),
          '/odom_ekf': ('/odom_ekf says', 'seagreen')}


def read_paths(bag):
    """For each of TOPICS that was recorded, all its (x, y, yaw): m and rad, the yaw not wrapped."""
    paths = {}
    with rosbag.Bag(bag) as file:
        for topic, message, _ in file.read_messages(list(TOPICS)):
            path = paths.setdefault(topic, [])
            pose = message.pose.pose
            yaw = 2 * atan2(pose.orientation.z, pose.orientation.w)
            if path:
                yaw += 2 * pi * round((path[-1][2] - yaw) / (2 * pi))
            path.append((pose.position.x, pose.position.y, yaw))
    return {topic: paths[topic] for topic in TOPICS if topic in paths}


def arrows(path):
    """The poses that are far enough from the one before to get an arrow of their own."""
    chosen = path[:1]
    for x, y, yaw in path:
        if hypot(x - chosen[-1][0], y - chosen[-1][1]) >= SPACING or abs(yaw - chosen[-1][2]) >= TURN:
            chosen.append((x, y, yaw))
    return chosen


def draw(paths, picture):
    """The arrows, seen from above."""
    figure, axes = pyplot.subplots(figsize=(9, 6))
    for topic, path in paths.items():
        name, color = TOPICS[topic]
        x, y, yaw = zip(*arrows(path))
        axes.quiver(x, y, [cos(a) for a in yaw], [sin(a) for a in yaw], color=color, label=name, angles='xy',
                    scale_units='xy', scale=1 / 0.3, width=0.004)
    axes.set(title='Out and back', xlabel='x (m)', ylabel='y (m)', xlim=(-0.5, 1.5), ylim=(-0.6, 0.9),
             aspect='equal', xticks=[-0.5, 0, 0.5, 1, 1.5], yticks=[-0.5, 0, 0.5])
    axes.grid(True)
    axes.legend(loc='upper right')
    figure.savefig(picture, dpi=100, bbox_inches='tight')


def main(bag, picture):
    """Report one run."""
    paths = read_paths(bag)
    if '/odom' not in paths:
        sys.exit('%s: no odometry: expected messages on /odom' % bag)
    for topic, path in paths.items():
        (x0, y0, yaw0), (x, y, yaw) = path[0], path[-1]
        print('Final pose, %-15s x %.4f m, y %.4f m, heading %.2f degrees; %.4f m from the start, %.2f degrees turned' % (
            TOPICS[topic][0] + ':', x, y, degrees(atan2(sin(yaw), cos(yaw))), hypot(x - x0, y - y0), degrees(yaw - yaw0)))
    draw(paths, picture)
    print('Bag:     %s' % bag)
    print('Picture: %s' % picture)


if __name__ == '__main__':
    main(*sys.argv[1:])
