"""The parameters of the floor under a simulated robot."""
from __future__ import annotations

from rbx1_nav.base.surfaces import Surface, known_surfaces, load_surface
from rbx1_nav.node import resources
from rbx1_nav.node.config import Section
from rbx1_nav.node.parameters import Parameter, custom, read
from rbx1_nav.simulation.slip import MAX_SEED, RANDOM, read_seed

SURFACE = custom(
    'surface', 'ideal', 'name of the floor, or absolute path of a surface file',
    lambda name: load_surface(name, resources.surfaces()),
    range=lambda: ', '.join(known_surfaces(resources.surfaces())),
    note='see [surface files](reference.md#surface-files)')


def seed(text: str) -> Parameter:
    """Declare the seed of the errors that `text` names."""
    return custom('seed', RANDOM, f'seed of {text}, or random', read_seed, range=f'0 to {MAX_SEED}',
                  note='the log shows it')


FLOOR = SURFACE, seed('slip and gyro errors')


def read_floor(section: Section) -> tuple[Surface | None, int]:
    """Return the surface (None: ideal) and the seed of a simulated base. Raises ConfigError."""
    values = read(FLOOR, section)
    return values['surface'], values['seed']
