"""The errors of a filter under a true and an assumed floor, and their limits; without ROS and without a simulator.

Units: meters, radians; headings in the results in degrees. A pose is (x, y, yaw).
"""
from collections import namedtuple
import math

import numpy

IDEAL, UNKNOWN = 'ideal', 'unknown'
TITLES = 'true floor', 'assumed', 'heading (degrees)', 'the port', 'position (cm)', 'the port', 'best', 'NEES'
CELLS = (('heading', 1, 2), ('port_heading', 1, 2), ('position', 100, 2), ('port_position', 100, 2),
         ('best_position', 100, 2), ('nees', 1, 1))     # figure, factor to the unit shown, decimals

Errors = namedtuple('Errors', 'ticks heading position nees')
Errors.__doc__ = """Sums over runs: number of ticks; squared errors of heading (degrees^2) and position (m^2) at all
ticks; normalized estimation error squared at the end (0 for the port)."""


def squared_errors(pose, truth):
    """Squared errors of the heading (degrees^2) and the position (m^2)."""
    return (math.degrees(math.remainder(pose[2] - truth[2], 2 * math.pi)) ** 2,
            (pose[0] - truth[0]) ** 2 + (pose[1] - truth[1]) ** 2)


def consistency(pose, truth, covariance):
    """The normalized estimation error squared; infinite if the covariance is not positive definite."""
    error = numpy.subtract(pose, truth)
    error[2] = math.remainder(error[2], 2 * math.pi)
    try:
        return float(numpy.sum(numpy.linalg.solve(numpy.linalg.cholesky(covariance), error) ** 2))
    except numpy.linalg.LinAlgError:
        return math.inf


class Follower:
    """Sums up the errors of an estimate in one run."""

    def __init__(self):
        self.ticks = 0
        self.heading = self.position = 0.0      # squares
        self.last = None    # (estimate, truth)

    def compare(self, pose, truth):
        """Compare the estimate after a tick with the truth."""
        self.last = pose, truth
        self.ticks += 1
        heading, position = squared_errors(pose, truth)
        self.heading += heading
        self.position += position

    def errors(self, covariance=None):
        """The Errors of the run. covariance: of the estimate at the end."""
        return Errors(self.ticks, self.heading, self.position,
                      0.0 if covariance is None else consistency(*self.last, covariance))


class KnownHeading:
    """Dead reckoning with the true heading and mean slip: no filter without another sensor can do better."""

    def __init__(self, slip):
        self.slip = slip
        self.pose = self.odom = None

    def update(self, odom, truth):
        """Add the displacement reported by odometry. odom, truth: poses (x, y, yaw)."""
        if self.odom is None:
            self.pose = tuple(truth)
        else:
            (x, y, yaw), (old_x, old_y, old_yaw) = odom, self.odom
            reported, real = (yaw + old_yaw) / 2, (truth[2] + self.pose[2]) / 2
            distance = (1 - self.slip) * ((x - old_x) * math.cos(reported) + (y - old_y) * math.sin(reported))
            self.pose = (self.pose[0] + distance * math.cos(real), self.pose[1] + distance * math.sin(real), truth[2])
        self.odom = tuple(odom)


def figures(runs):
    """Root mean squares over all ticks, and the mean NEES. runs: for each run, the Errors of the filter, of the port
    and of KnownHeading."""
    errors, port, best = (Errors(*map(float, each)) for each in numpy.sum(runs, axis=0))
    values = dict(nees=errors.nees / len(runs))
    for name, sums in ('', errors), ('port_', port), ('best_', best):
        values[f'{name}heading'] = math.sqrt(sums.heading / sums.ticks)
        values[f'{name}position'] = math.sqrt(sums.position / sums.ticks)
    return values


def limits(true, assumed, values, unobservable):
    """{figure: (minimum, maximum)} for a pair of floors.

    unobservable: m, the error of the assumed straight slip times the path, which nothing on the robot can measure.
    """
    heading, position = 1.1 * values['port_heading'] + 0.1, 1.1 * values['port_position'] + 0.002
    if true == assumed:
        if true == IDEAL:
            return dict(heading=(0, 0.1), position=(0, 0.002), nees=(0, 5))
        return dict(heading=(0, heading), position=(0, 0.8 * values['port_position']), nees=(0.7, 5))
    if assumed == UNKNOWN:
        return dict(heading=(0, heading), position=(0, position), nees=(0 if true == IDEAL else 0.7, 5))
    return dict(heading=(0, heading), position=(0, position + unobservable), nees=(0, 10))


def misses(values, bounds):
    """The figures that are beyond their limits."""
    return [name for name, (least, greatest) in bounds.items() if not least <= values[name] <= greatest]


def report(lines, rows):
    """Print the lines of a table, and how many of its rows have no `misses`."""
    print('\n'.join(lines))
    print('%d of %d rows within all limits' % (sum(not row['misses'] for row in rows), len(rows)))


def markdown(rows):
    """The rows in Markdown, one line per pair of floors. Each cell has a value per method, bold if beyond its limit."""
    yield f"| {' | '.join(TITLES)} |"
    yield f"|{'---|' * len(TITLES)}"
    pairs = {}
    for row in rows:
        pairs.setdefault((row['true'], row['assumed']), []).append(row)
    for floors, methods in pairs.items():
        yield '| %s |' % ' | '.join([*floors, *(', '.join(markdown_value(row, *cell) for row in methods)
                                                for cell in CELLS)])


def markdown_value(row, name, factor, places):
    """A figure of a row, multiplied by a factor."""
    return ('**%.*f**' if name in row['misses'] else '%.*f') % (places, factor * row[name])
