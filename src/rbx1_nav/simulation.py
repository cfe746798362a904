"""The exercise without ROS: maneuver, base and filter are the nodes' own, and a tick takes no longer than its sums.

Metres, radians, seconds.
"""
from collections import namedtuple
from functools import partial
from math import pi
import multiprocessing
import signal

from rbx1_nav.base import SECOND, Base
from rbx1_nav.ekf import CombinedOdometry, Imu, Odom, priors
from rbx1_nav.gyro import Gyro, IdealGyro
from rbx1_nav.maneuver import out_and_back, out_and_back_by_odometry
from rbx1_nav.surface import draw
from rbx1_nav.wheels import IdealWheels, Wheels

METHODS = ('timed', 'odom', 'ekf')

# the tutorial's numbers, the nodes' defaults: m/s, m, rad/s, rad, Hz
EXERCISE = dict(linear_speed=0.2, goal_distance=1.0, angular_speed=1.0, goal_angle=pi, rate=50)
SLOWEST = dict(min_linear_speed=0.05, min_angular_speed=0.2)
TICK = SECOND // EXERCISE['rate']   # ns
SLOWEST_WINDOW = 0.1    # s
REST = 50       # ticks between two motions
CALIBRATION = 100   # ticks that the robot stands before the first motion, for the filter to learn the gyro's bias

Snapshot = namedtuple('Snapshot', 'time truth odometry estimate')
Snapshot.__doc__ = 'Time since the start (s) and three Poses; estimate: of the filter, None where there is none.'

Result = namedtuple('Result', 'end first_leg covariance path')
Result.__doc__ = """A run: Snapshot of its end, true distance at the end of the first motion (m), the 3x3 covariance of the
filter's pose (m and rad; None without a filter), and all Snapshots on the way, if they were to be kept."""


def make_robot(config, surface, seed):
    """(Base, gyro) of a robot (a Config) on a surface (a Surface, or None); seed: a whole number that a run is drawn from."""
    if surface is None:
        wheels, gyro = IdealWheels(config.base_width), IdealGyro()
    else:
        run = draw(surface, seed)
        # odometry tells the speed since its last message
        wheels = Wheels(config.base_width, surface, run, min(1 / config.rate, SLOWEST_WINDOW))
        gyro = Gyro(surface, run, seed)
    return Base(wheels, config.limits, config.timeout), gyro


class Simulation:
    """A robot, and a filter that watches it, on a clock that nobody waits for."""

    def __init__(self, config, surface, seed, filtered, keep):
        """filtered: whether there is a filter; keep: whether to keep a Snapshot of each tick, in `path`."""
        self.base, self.gyro = make_robot(config, surface, seed)
        self.filter = CombinedOdometry(priors(surface), SECOND) if filtered else None
        self.path = [] if keep else None
        self.now = 0

    def tick(self):
        """Let a tick pass."""
        base = self.base
        self.now += TICK
        base.advance(self.now)
        if self.filter:
            reading = self.gyro.read(base.wheels.truth.pose.yaw, TICK / SECOND, base.standing)
            uncertainty = base.wheels.uncertainty
            self.filter.add_imu(self.now, Imu(self.now, reading.rate, reading.rate_variance))
            self.filter.add_odom(self.now, Odom(self.now, base.odometry.pose, uncertainty.linear, uncertainty.angular),
                                 (uncertainty.position, uncertainty.position, uncertainty.yaw))
        if self.path is not None:
            self.path.append(self.snapshot())

    def rest(self, ticks):
        """Stand for so many ticks."""
        self.base.command(self.now, 0.0, 0.0)
        for _ in range(ticks):
            self.tick()

    def snapshot(self):
        """How it is now."""
        return Snapshot(self.now / SECOND, self.base.wheels.truth.pose, self.base.odometry.pose,
                        self.filter.estimate.pose if self.filter else None)

    def drive_by_time(self, motion):
        """One motion of timed_out_and_back.py."""
        for _ in range(motion.ticks):
            self.base.command(self.now, motion.linear, motion.angular)
            self.tick()

    def drive_by_pose(self, leg, where):
        """One leg of odom_out_and_back.py; where(): the Pose that it asks for."""
        while True:
            speed = leg.next_speed(where())
            if not speed:
                return
            self.base.command(self.now, *leg.velocity(speed))
            self.tick()


def simulate(method, config, surface, seed, filtered=False, keep=False):
    """The exercise by one of METHODS; returns a Result. Raises StuckError.

    config: a Config; surface: a Surface, or None; seed: what is drawn for the run; filtered: whether a filter watches, as it
    always does for `ekf`; keep: whether to keep the path.
    """
    simulation = Simulation(config, surface, seed, filtered or method == 'ekf', keep)
    simulation.rest(CALIBRATION)
    if method == 'timed':
        motions, drive = out_and_back(**EXERCISE), simulation.drive_by_time
    else:
        motions = out_and_back_by_odometry(**EXERCISE, **SLOWEST)

        def drive(leg):
            simulation.drive_by_pose(leg, lambda: (simulation.filter.estimate if method == 'ekf'
                                                   else simulation.base.odometry).pose)
    first_leg = None
    for motion in motions:
        drive(motion)
        simulation.rest(REST)
        if first_leg is None:
            first_leg = simulation.base.wheels.truth.pose.x
    return Result(simulation.snapshot(), first_leg, simulation.filter.estimate.covariance if simulation.filter else None,
                  simulation.path)


def simulate_many(method, config, surface, seeds, keep=0, jobs=1):
    """Yields the Results of all seeds in their order; keep: of how many to keep the path; jobs: number of processes."""
    work = partial(_simulate_one, method, config, surface)
    tasks = ((seed, number < keep) for number, seed in enumerate(seeds))
    if jobs == 1:
        yield from map(work, tasks)
        return
    with multiprocessing.Pool(jobs, _leave_signals_to_the_parent) as pool:
        yield from pool.imap(work, tasks, chunksize=max(1, min(50, len(seeds) // 100)))


def _leave_signals_to_the_parent():
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    signal.signal(signal.SIGTERM, signal.SIG_DFL)   # by which the parent ends it


def _simulate_one(method, config, surface, task):
    seed, keep = task
    return simulate(method, config, surface, seed, keep=keep)
