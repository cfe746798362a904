"""The robot and the floors of this package, and processes that simulate them; without ROS."""
from concurrent.futures import ProcessPoolExecutor
import os

from rbx1_nav.base.robot_parameters import load_robot
from rbx1_nav.base.surfaces import known_surfaces, load_surface

CONFIG = os.path.join(os.path.dirname(os.path.realpath(__file__)), '..', 'config')


def robot():
    """The Robot, a TurtleBot."""
    return load_robot(os.path.join(CONFIG, 'turtlebot.yaml'))


def floor(name):
    """A Surface, or the one of a YAML file; None for the ideal floor."""
    return load_surface(name, os.path.join(CONFIG, 'surfaces'))


def floors():
    """{name: Surface} of all floors."""
    return {name: floor(name) for name in known_surfaces(os.path.join(CONFIG, 'surfaces'))}


def in_processes(jobs, function, tasks):
    """Yield the results of a function for all tasks, in their order. jobs: number of processes."""
    with ProcessPoolExecutor(jobs) as pool:
        yield from pool.map(function, tasks)
