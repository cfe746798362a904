"""Invalid configurations, passed to everything that reads one."""
from functools import lru_cache
import math
import os

import rospkg
import yaml

from bad_values import TEXTS, VALUES, mutate, shown
from rbx1_nav.config import ConfigError, Section
from rbx1_nav.parameters import number, read
from rbx1_nav.robot.description import read_robot
from rbx1_nav.ros.filter.ekf_parameters import read_parameters
from rbx1_nav.simulation.base import make_base
from rbx1_nav.simulation.surfaces import load_surface, read_seed, read_surface
from rbx1_nav.units import SECOND

FAULT = 'generated configurations of robot, surface, seed, filter and scripts'
PROMISE = 'a one-line error that names the key, or finite values with a period of at most one hour'
FULL, SHORT = 10000, 2000
ROOT = ALONE = False

CONFIG = os.path.join(rospkg.RosPack().get_path('rbx1_nav'), 'config')


@lru_cache(None)
def load(*path):
    """The contents of a YAML file in config/."""
    with open(os.path.join(CONFIG, *path), encoding='utf-8') as file:
        return yaml.safe_load(file)


def load_robot(name):
    """A robot's file, with all keys that the simulated base knows."""
    controller = dict(load(name)['controllers']['base_controller'], odom_frame_id='odom', rate=50.0, timeout=1.0,
                      max_linear_speed=0.5, max_angular_speed=2.0, wheel_radius=0.033)
    return dict(load(name), publish_tf=True, controllers={'base_controller': controller})


def use_robot(values):
    """Numbers that the base publishes after one period, and that period."""
    robot = read_robot(values)
    base = make_base(robot, None, 1)
    base.command(0, min(0.2, robot.limits.linear), min(1.0, robot.limits.angular))
    base.advance(round(SECOND / robot.rate))
    angles = [travel / robot.wheel_radius for travel in (base.left, base.right)]
    return [*base.odometry.pose, *base.velocity, *angles, *(joint.position for joint in robot.joints)], 1 / robot.rate


def use_surface(values):
    """Numbers that a base on the surface publishes after one period."""
    base = make_base(read_robot(load('turtlebot.yaml')), read_surface(values, 'of the test') if values else None, 1)
    base.command(0, 0.2, 1.0)
    base.advance(SECOND // 50)
    return [*base.odometry.pose, *base.wheels.truth.pose, *base.wheels.uncertainty], 0


def use_text(text):
    """The same for the text of a file."""
    with open('surface.yaml', 'w', encoding='utf-8') as file:
        file.write(text)
    load_surface(os.path.abspath('surface.yaml'), os.path.join(CONFIG, 'surfaces'))
    return [], 0


def use_filter(values):
    """The filter's numbers, and its period."""
    parameters = read_parameters(values)
    return [parameters.sensor_timeout, *parameters.limits], 1 / parameters.freq


SCRIPT = number('linear_speed', 0.2, 'm/s', ''), number('rate', 50, 'Hz', '', 2, 1000)     # as in the script


def use_script(values):
    """A script's numbers, and its period."""
    numbers = read(SCRIPT, Section(values))
    return numbers.values(), 1 / numbers['rate']


def use_seed(value):
    """A seed."""
    return [read_seed(value)], 0


def check(use, values, key):
    """One configuration. key: must be named in the error, unless None."""
    try:
        numbers, period = use(values)
    except ConfigError as error:
        text = str(error)
        assert len(text.splitlines()) == 1 and 'expected' in text, f'expected one line: {text[:500]!r}'
        assert text.isprintable() and len(text) < 1000, f'unreadable: {len(text)} characters, {text[:500]!r}'
        assert key is None or str(key) in text, f'{key} is not named in: {text}'
    else:
        assert all(map(math.isfinite, numbers)) and period <= 3600, f'{numbers}, a period of {period:g} s'


def generate(row):
    """One configuration: what uses it, and the other arguments of check()."""
    kind = row.random.randrange(6)
    if kind == 0:
        return use_text, '\n'.join(text.replace('%s', 'lag') for text in row.random.sample(TEXTS, 2)), None
    if kind == 1:
        return use_seed, row.random.choice(VALUES), 'seed'
    use, values = [
        (use_robot, load_robot(row.random.choice(['turtlebot.yaml', 'pi_robot.yaml']))),
        (use_surface, load('surfaces', row.random.choice(['hard_floor.yaml', 'low_ply_carpet.yaml']))),
        (use_filter, dict(freq=10.0, sensor_timeout=1.0, publish_tf=True, odom_used=True, imu_used=True, vo_used=False,
                          output_frame='odom', surface='hard_floor', max_speed=6.0, gyro_bias=10.0)),
        (use_script, dict(rate=50, linear_speed=0.2))][kind - 2]
    return (use,) + mutate(row.random, values)


def run(row):
    """See FAULT."""
    row.roscore()   # which is asked for what is missing
    for _ in range(row.times):
        use, values, key = generate(row)
        with row.fault(f'{use.__name__}({shown(values)})'):
            check(use, values, key)
