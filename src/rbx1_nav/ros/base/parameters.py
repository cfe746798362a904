"""The parameters of the simulated robots."""
from __future__ import annotations

from rbx1_nav.config import ConfigError, Section, YamlValue, show
from rbx1_nav.create.emulator.body import BodyErrors, Quirks
from rbx1_nav.create.protocol import BAUD_RATES, CREATE, CREATE_2, MODELS
from rbx1_nav.parameters import Parameter, choice, custom, elsewhere, flag, number, read
from rbx1_nav.robot.description import DRIVER_KEYS, PARAMETERS as ROBOT
from rbx1_nav.ros.node import resources
from rbx1_nav.schedule import CLOCK_STEP
from rbx1_nav.simulation.surfaces import MAX_SEED, RANDOM, Surface, known_surfaces, load_surface, read_seed


def _surface_names() -> str:
    return ', '.join(known_surfaces(resources.surfaces()))


SURFACE = custom(
    'surface', 'ideal', 'name of the floor, or absolute path of a surface file',
    lambda name: load_surface(name, resources.surfaces()), range=_surface_names,
    note='see [surface files](files.md#surface-files)')


def _seed(text: str) -> Parameter:
    return custom('seed', RANDOM, f'seed of {text}, or random', read_seed, range=f'0 to {MAX_SEED}',
                  note='the log shows it')


_CLOCK = (
    number('real_time_factor', None, '', 'highest speed of simulated time, relative to real time', 0.01, 1000,
           shown='real time', note='see [Simulated time](frames_and_time.md#simulated-time)'),
    number('clock_step', CLOCK_STEP, 's', 'step of simulated time', 0.001, 0.1, 'a time'),
    flag('strict', False, 'whether this node exits if a driver is not in step with simulated time',
         note='see [Simulated time](frames_and_time.md#simulated-time)'))

FAKE_BASE = (
    *ROBOT,
    SURFACE,
    _seed('slip and gyro errors'),
    *_CLOCK,
    *(elsewhere(name, 'ArbotiX parameter, accepted and ignored')
      for name in sorted({'diagnostic_period', *DRIVER_KEYS})))


def read_floor(section: Section) -> tuple[Surface | None, int]:
    """Return the surface (None: ideal) and the seed of a simulated base. Raises ConfigError."""
    values = read([each for each in FAKE_BASE if each.name in ('surface', 'seed')], section)
    return values['surface'], values['seed']


FLEET = (
    number('robots', 0, '', 'number of robots at the beginning: robot1, robot2 and so on; the parameters of a base are '
           'below robot1/arbotix', 0, 1000, 'a number'),
    number('spacing', 1.0, 'm', 'distance between the origins of the odometry of neighbors, in the frame map', 0, 1000,
           'a distance'),
    choice('method', ('none', 'timed', 'odometry'), 'none', 'script that fleet.launch starts for each robot'),
    number('rate', 50.0, 'Hz', 'rate at which the bases are updated; odometry at most', 1, 1000, 'a rate'),
    *_CLOCK)


def _check_link(link: YamlValue) -> str:
    if not isinstance(link, str):
        raise ConfigError(f'link: {show(link)}: expected a path')
    return link


_BODY = {
    'gyro_sensitivity': "ratio of the gyro's sensitivity to its nominal value",
    'wheel_travel': 'ratio of the distance counted by the encoders to the distance traveled by the wheels',
    'wheel_base': 'ratio of the true wheel separation to its nominal value'}
_QUIRKS = {
    'mode_plus_one': 'whether the robot reports its mode plus one, like a Roomba 642 and other models with Wi-Fi',
    'drops_fractions': 'whether each reading of the angle starts at 0 and loses the fraction of a degree'}

FAKE_CREATE = (
    choice('robot_type', tuple(MODELS), CREATE.name, 'model of the robot'),
    choice('baud', BAUD_RATES, None, 'rate after the robot is switched on; 19200: its power button was held',
           'bits per second', shown=f'{CREATE.baud}; {CREATE_2.name}: {CREATE_2.baud}'),
    custom('link', '', 'path of a symbolic link to the device', _check_link, shown='none',
           note="the log shows the device's name"),
    SURFACE,
    _seed('slip, gyro errors and corruption'),
    number('charge', 1.0, '', 'charge that the robot reports, as a fraction of the capacity of its battery', 0, 2),
    number('battery_temperature', 25.0, 'degrees C', 'temperature of the battery', -40, 100, 'a temperature'),
    number('battery_voltage', 0.0, 'V', 'voltage of the battery; 0: it follows the charge', 0, 25, 'a voltage'),
    number('corruption', 0.0, '', 'fraction of the bytes to the host that are flipped, lost or doubled', 0, 1),
    number('gyro_measurement_range', 150.0, 'degrees/s', 'full-scale turn rate of the gyro', 1, 1e5),
    *(number(name, 1.0, '', _BODY[name], 0.1, 10, 'a factor') for name in BodyErrors._fields),
    number('gyro_stuck', -1.0, '', 'count at which the analog input is stuck; -1: it is not stuck', -1, 1023,
           'a count'),
    *(flag(name, False, _QUIRKS[name]) for name in Quirks._fields))
