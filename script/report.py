#!/usr/bin/python3
"""Prints where a recorded run ended, and draws its odometry as arrows: report.py BAG PICTURE"""
import sys
from math import atan2, cos, degrees, hypot, pi, sin

import matplotlib
import rosbag

matplotlib.use('Agg')
from matplotlib import pyplot       # noqa: E402  (the backend comes first)

SPACING, TURN = 0.1, 0.15       # m and rad between two arrows, as in sim.rviz


def poses(path):
    """All (x, y, yaw) of /odom in a bag: m and rad, the yaw not wrapped."""
    result = []
    with rosbag.Bag(path) as bag:
        for _, message, _ in bag.read_messages('/odom'):
            pose = message.pose.pose
            yaw = 2 * atan2(pose.orientation.z, pose.orientation.w)
            if result:
                yaw += 2 * pi * round((result[-1][2] - yaw) / (2 * pi))
            result.append((pose.position.x, pose.position.y, yaw))
    return result


def arrows(path):
    """The poses that are far enough from the one before to get an arrow of their own."""
    chosen = path[:1]
    for x, y, yaw in path:
        if hypot(x - chosen[-1][0], y - chosen[-1][1]) >= SPACING or abs(yaw - chosen[-1][2]) >= TURN:
            chosen.append((x, y, yaw))
    return chosen


def draw(path, picture):
    """The arrows, seen from above."""
    x, y, yaw = zip(*arrows(path))
    figure, axes = pyplot.subplots(figsize=(9, 6))
    axes.quiver(x, y, [cos(a) for a in yaw], [sin(a) for a in yaw], color='firebrick', angles='xy',
                scale_units='xy', scale=1 / 0.3, width=0.004)
    axes.set(title='Odometry, out and back', xlabel='x (m)', ylabel='y (m)', xlim=(-0.5, 1.5), ylim=(-0.6, 0.6),
             aspect='equal', xticks=[-0.5, 0, 0.5, 1, 1.5], yticks=[-0.5, 0, 0.5])
    axes.grid(True)
    figure.savefig(picture, dpi=100, bbox_inches='tight')


def main(bag, picture):
    """Report one run."""
    path = poses(bag)
    if not path:
        sys.exit('%s: no odometry: expected messages on /odom' % bag)
    (x0, y0, yaw0), (x, y, yaw) = path[0], path[-1]
    print('Final pose               x %.4f m, y %.4f m, heading %.2f degrees' % (x, y, degrees(atan2(sin(yaw), cos(yaw)))))
    print('Distance from the start  %.4f m' % hypot(x - x0, y - y0))
    print('Angle turned             %.2f degrees' % degrees(yaw - yaw0))
    draw(path, picture)
    print('Bag                      %s' % bag)
    print('Picture                  %s' % picture)


if __name__ == '__main__':
    main(*sys.argv[1:])
