"""The exercise without ROS: the same motions, base and filter as in the nodes, as fast as they can be computed.

Metres, radians, seconds.
"""
from collections import deque, namedtuple
from concurrent.futures import ProcessPoolExecutor
from functools import partial
from math import pi
import multiprocessing
import os
import signal
import threading

from rbx1_nav.control.legs import out_and_back_by_odometry
from rbx1_nav.control.motions import out_and_back
from rbx1_nav.estimation.combined_odometry import CombinedOdometry
from rbx1_nav.estimation.filter import priors
from rbx1_nav.estimation.inputs import Imu, Odom
from rbx1_nav.simulation.base import make_base
from rbx1_nav.units import SECOND

METHODS = ('timed', 'odom', 'ekf')

# the tutorial's numbers, the nodes' defaults: m/s, m, rad/s, rad, Hz
EXERCISE = dict(linear_speed=0.2, goal_distance=1.0, angular_speed=1.0, goal_angle=pi, rate=50)
MIN_SPEEDS = dict(min_linear_speed=0.05, min_angular_speed=0.2)
TICK = SECOND // EXERCISE['rate']   # ns
REST = 50       # ticks between two motions
TRIAL_REST = 25     # ticks at the trial stop of a leg
CALIBRATION = 100   # ticks at rest before the first motion, in which the filter estimates the gyro's bias

Snapshot = namedtuple('Snapshot', 'time truth odometry estimate')
Snapshot.__doc__ = 'Time since the start (s) and three Poses; estimate: of the filter, None if there is none.'

SimulationResult = namedtuple('SimulationResult', 'end first_leg covariance path')
SimulationResult.__doc__ = """A run: Snapshot of its end, true distance at the end of the first motion (m), the 3x3
covariance of the filter's pose (m and rad; None without a filter), and all Snapshots (None if not kept)."""

Messages = namedtuple('Messages', 'imu orientation odom pose_variances')
Messages.__doc__ = """What the base publishes at a tick: Imu, (yaw, variance) of its orientation (rad, rad^2), Odom, and
variances of its pose's x, y (m^2) and yaw (rad^2)."""


def feed(combined, messages):
    """Give a CombinedOdometry the Messages of a tick."""
    now = messages.odom.stamp
    combined.add_imu(now, messages.imu)
    combined.add_odom(now, messages.odom, messages.pose_variances)


class Simulation:
    """A robot, and a filter that receives its odometry and gyro readings."""

    def __init__(self, robot, surface, seed, filtered, keep, prior=None, listen=None):
        """filtered: whether there is a filter; keep: whether to keep a Snapshot of each tick in `path`; prior, listen:
        see simulate()."""
        self.base = make_base(robot, surface, seed)
        self.filter = CombinedOdometry(prior or priors(surface), SECOND) if filtered else None
        self.listen = listen
        if filtered or listen:
            self.base.read_gyro()       # readings begin now
        self.path = [] if keep else None
        self.now = 0

    def tick(self):
        """Advance by one tick."""
        self.now += TICK
        self.base.advance(self.now)
        messages = self._messages() if self.filter or self.listen else None
        if self.filter:
            feed(self.filter, messages)
        if self.path is not None:
            self.path.append(self.snapshot())
        if self.listen:
            self.listen(self.snapshot(), messages)

    def _messages(self):
        reading, uncertainty = self.base.read_gyro(), self.base.wheels.uncertainty
        return Messages(Imu(self.now, reading.rate, reading.rate_variance), (reading.yaw, reading.yaw_variance),
                        Odom(self.now, self.base.odometry.pose, uncertainty.linear, uncertainty.angular),
                        (uncertainty.position, uncertainty.position, uncertainty.yaw))

    def rest(self, ticks):
        """Stand still for a number of ticks."""
        self.base.command(self.now, 0.0, 0.0)
        for _ in range(ticks):
            self.tick()

    def snapshot(self):
        """The present Snapshot."""
        return Snapshot(self.now / SECOND, self.base.wheels.truth.pose, self.base.odometry.pose,
                        self.filter.estimate.pose if self.filter else None)

    def drive_by_time(self, motion):
        """One motion of timed_out_and_back.py."""
        for _ in range(motion.ticks):
            self.base.command(self.now, motion.linear, motion.angular)
            self.tick()

    def drive_by_pose(self, leg, get_pose):
        """One leg of odom_out_and_back.py; get_pose(): the Pose that it is controlled by."""
        self._drive_to_stop(leg, get_pose)
        self.rest(TRIAL_REST)
        self._drive_to_stop(leg, get_pose)

    def _drive_to_stop(self, leg, get_pose):
        while True:
            speed = leg.next_speed(get_pose())
            if not speed:
                return
            self.base.command(self.now, *leg.velocity(speed))
            self.tick()


def simulate(method, robot, surface, seed, filtered=False, keep=False, prior=None, listen=None):
    """The exercise by one of METHODS; returns a SimulationResult. Raises StuckError.

    robot: a Robot; surface: a Surface, or None; seed: of the run's random errors; filtered: whether to run the filter,
    as `ekf` always does; keep: whether to keep the path; prior: Priors of the filter, if not those of the surface;
    listen(Snapshot, Messages): called at each tick.
    """
    simulation = Simulation(robot, surface, seed, filtered or method == 'ekf', keep, prior, listen)
    simulation.rest(CALIBRATION)
    if method == 'timed':
        motions, drive = out_and_back(**EXERCISE), simulation.drive_by_time
    else:
        motions = out_and_back_by_odometry(**EXERCISE, **MIN_SPEEDS)

        def drive(leg):
            simulation.drive_by_pose(leg, lambda: (simulation.filter.estimate if method == 'ekf'
                                                   else simulation.base.odometry).pose)
    first_leg = None
    for motion in motions:
        drive(motion)
        simulation.rest(REST)
        if first_leg is None:
            first_leg = simulation.base.wheels.truth.pose.x
    covariance = simulation.filter.estimate.covariance if simulation.filter else None
    return SimulationResult(simulation.snapshot(), first_leg, covariance, simulation.path)


def simulate_many(method, robot, surface, seeds, keep=0, jobs=1):
    """Yields the Results of all seeds in their order; keep: the number of paths to keep; jobs: number of processes.

    Closing it ends the processes. Raises BrokenProcessPool if one of them is killed.
    """
    work = partial(_simulate_some, method, robot, surface)
    tasks = [(seed, number < keep) for number, seed in enumerate(seeds)]
    if jobs == 1:
        for task in tasks:
            yield from work([task])
        return
    size = max(1, min(50, len(tasks) // 100))
    chunks = [tasks[start:start + size] for start in range(0, len(tasks), size)]
    jobs = min(jobs, len(chunks))
    with ProcessPoolExecutor(max(1, jobs), initializer=_follow_the_parent) as pool:
        results = deque()
        try:
            for chunk in chunks:
                results.append(pool.submit(work, chunk))
                if len(results) > 4 * jobs:     # enough for all processes, and not everything in memory
                    yield from results.popleft().result()
            while results:
                yield from results.popleft().result()
        except BaseException:       # do not wait for runs that nobody will see
            for process in multiprocessing.active_children():
                process.kill()
            raise


def _follow_the_parent():
    """In a new process: leave Ctrl-C to the parent, and end when it ends, even if it was killed."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    signal.signal(signal.SIGTERM, signal.SIG_DFL)
    threading.Thread(target=_end_with_the_parent, daemon=True).start()


def _end_with_the_parent():
    multiprocessing.parent_process().join()
    os._exit(1)


def _simulate_some(method, robot, surface, tasks):
    """The Results of some tasks: pairs of a seed and whether to keep the path."""
    return [simulate(method, robot, surface, seed, keep=keep) for seed, keep in tasks]
