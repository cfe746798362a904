"""The exercise without ROS: runs the motions, the base and the filter of the nodes at full speed.

Meters, radians, seconds.
"""
from __future__ import annotations

from functools import partial
from math import pi
from typing import Callable, Mapping, NamedTuple

from rbx1_nav.base.kinematics import Pose
from rbx1_nav.base.robot_parameters import Robot
from rbx1_nav.base.surfaces import Surface
from rbx1_nav.base.units import SECOND, Covariance
from rbx1_nav.exercise.legs import REST, TRIAL_REST, Leg, Motion, out_and_back, out_and_back_by_odometry
from rbx1_nav.exercise.methods import METHODS
from rbx1_nav.filter.combined_odometry import CombinedOdometry
from rbx1_nav.filter.input_checks import Imu, Odom
from rbx1_nav.filter.priors import Priors, priors
from rbx1_nav.simulation.floor import Floor
from rbx1_nav.simulation.simulated_base import make_base

# the tutorial's values, which are the nodes' defaults: m/s, m, rad/s, rad, Hz
EXERCISE = dict(linear_speed=0.2, goal_distance=1.0, angular_speed=1.0, goal_angle=pi, rate=50)
MIN_SPEEDS = dict(min_linear_speed=0.05, min_angular_speed=0.2)
PARAMETERS: dict[str, float] = {**EXERCISE, **MIN_SPEEDS}
TICK = round(SECOND / EXERCISE['rate'])     # ns
CALIBRATION = 2.0   # s at rest before the first motion, during which the filter estimates the gyro's bias


class Snapshot(NamedTuple):
    """The true, the measured and the estimated pose of the robot at one time."""

    time: float             # s since the start
    truth: Pose
    odometry: Pose
    estimate: Pose | None   # pose of the filter; None without a filter


class SimulationResult(NamedTuple):
    end: Snapshot
    first_leg: float            # m, true distance after the first motion
    covariance: Covariance | None   # of the filter's pose; None without a filter
    path: list[Snapshot] | None     # Snapshots of all ticks; None if not kept


class Messages(NamedTuple):
    """The messages that the base publishes at a tick."""

    imu: Imu
    orientation: tuple[float, float]        # yaw (rad) and its variance (rad^2)
    odom: Odom
    pose_variances: tuple[float, float, float]      # variances of the pose's x, y (m^2) and yaw (rad^2)


def feed(combined: CombinedOdometry, imu: Imu, odom: Odom) -> None:
    """Pass the messages of a tick to a CombinedOdometry."""
    combined.add_imu(imu.stamp, imu)
    combined.add_odom(odom.stamp, odom)


Listen = Callable[[Snapshot, Messages], None]


class Simulation:
    """A robot, and a filter that receives its odometry and gyro readings."""

    def __init__(self, robot: Robot, surface: Surface | None, seed: int, filtered: bool, keep: bool,
                 prior: Priors | None = None, listen: Listen | None = None, rate: float = EXERCISE['rate'],
                 floor: Floor | None = None) -> None:
        """filtered: whether there is a filter; keep: whether to keep a Snapshot of each tick in `path`; prior, listen,
        floor: see simulate(); rate: ticks per second."""
        self.base = make_base(robot, surface, seed, floor)
        self.filter = CombinedOdometry(prior or priors(surface), SECOND) if filtered else None
        self.listen = listen
        if filtered or listen:
            self.base.read_gyro()       # readings begin now
        self.path: list[Snapshot] | None = [] if keep else None
        self.now = 0
        self.rate, self.period = rate, round(SECOND / rate)

    def tick(self) -> None:
        self.now += self.period
        self.base.advance(self.now)
        if self.filter or self.listen:
            self._send()
        if self.path is not None:
            self.path.append(self.snapshot())

    def _send(self) -> None:
        """Pass the messages of this tick to the filter and to the listener."""
        base, now = self.base, self.now
        reading = base.read_gyro()
        assert reading      # the clock has advanced
        imu = Imu(now, reading.rate, reading.rate_variance)
        odom = Odom(now, base.odometry.pose, *base.wheels.speed_variances)
        if self.filter:
            feed(self.filter, imu, odom)
        if self.listen:
            position, yaw = base.wheels.uncertainty[:2]
            self.listen(self.snapshot(), Messages(imu, (reading.yaw, reading.yaw_variance), odom,
                                                  (position, position, yaw)))

    def rest(self, duration: float) -> None:
        """Keep the robot at rest for a duration (s)."""
        self.base.command(self.now, 0.0, 0.0)
        for _ in range(round(duration * self.rate)):
            self.tick()

    def snapshot(self) -> Snapshot:
        return Snapshot(self.now / SECOND, self.base.wheels.truth.pose, self.base.odometry.pose,
                        self.filter.pose if self.filter else None)

    def drive_by_time(self, motion: Motion) -> None:
        """Drive one motion of timed_out_and_back.py."""
        for _ in range(motion.ticks):
            self.base.command(self.now, motion.linear, motion.angular)
            self.tick()

    def drive_by_pose(self, leg: Leg, get_pose: Callable[[], Pose]) -> None:
        """Drive one leg of odom_out_and_back.py. get_pose(): returns the Pose that controls the leg."""
        self._drive_to_stop(leg, get_pose)
        self.rest(TRIAL_REST)
        self._drive_to_stop(leg, get_pose)

    def _drive_to_stop(self, leg: Leg, get_pose: Callable[[], Pose]) -> None:
        while True:
            speed = leg.next_speed(get_pose())
            if not speed:
                return
            self.base.command(self.now, *leg.velocity(speed))
            self.tick()


def simulate(method: str, robot: Robot, surface: Surface | None, seed: int, filtered: bool = False, keep: bool = False,
             prior: Priors | None = None, listen: Listen | None = None,
             parameters: Mapping[str, float] = PARAMETERS, floor: Floor | None = None) -> SimulationResult:
    """Run the exercise with one of METHODS, and return a SimulationResult. Raises StuckError.

    robot: a Robot; surface: a Surface, or None; seed: seed of the run's random errors; filtered: whether to run the
    filter, which always runs if its pose stops the motions; keep: whether to keep the path; prior: Priors of the
    filter, if they differ from the surface; listen(Snapshot, Messages): called at each tick; parameters: all PARAMETERS
    with their values; floor: in place of the seed's, for many runs without a filter, whose true poses are arrays.
    """
    filtered = filtered or METHODS[method].filtered
    simulation = Simulation(robot, surface, seed, filtered, keep, prior, listen, parameters['rate'], floor)
    return run(simulation, method, parameters)


def run(simulation: Simulation, method: str, parameters: Mapping[str, float] = PARAMETERS) -> SimulationResult:
    """Run the exercise with a new Simulation; see simulate()."""
    simulation.rest(CALIBRATION)
    distances = []
    for drive in _drives(simulation, method, parameters):
        drive()
        simulation.rest(REST)
        distances.append(simulation.base.wheels.truth.x)
    estimate = simulation.filter.estimate if simulation.filter else None
    return SimulationResult(simulation.snapshot(), distances[0], estimate.covariance if estimate else None,
                            simulation.path)


def motions(parameters: Mapping[str, float]) -> list[Motion]:
    """Return the motions of the timed exercise. Raises ValueError if one of them is too short or too long."""
    return out_and_back(**{name: parameters[name] for name in EXERCISE})


def _drives(simulation: Simulation, method: str, parameters: Mapping[str, float]) -> list[Callable[[], None]]:
    """Return four functions, each of which drives one motion of the exercise."""
    pose = METHODS[method].pose
    if not pose:
        return [partial(simulation.drive_by_time, motion) for motion in motions(parameters)]
    combined = simulation.filter if pose == 'estimate' else None

    def get_pose() -> Pose:
        estimate = combined.pose if combined else None
        return estimate or simulation.base.odometry.pose
    return [partial(simulation.drive_by_pose, leg, get_pose) for leg in out_and_back_by_odometry(**parameters)]
