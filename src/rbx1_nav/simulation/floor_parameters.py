"""The parameters of the floor under a simulated robot."""
from __future__ import annotations

from typing import Callable, Mapping

from rbx1_nav.base.surfaces import Surface, known_surfaces, load_surface
from rbx1_nav.node import resources
from rbx1_nav.node.config import ConfigError, Section, YamlValue, show
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


class ChosenFloor:
    """Surface and seed of a running base, which may change between two of its runs."""

    def __init__(self, stored: Callable[[], Mapping[str, YamlValue]]) -> None:
        """stored(): returns the private parameters of this node that are set."""
        self.stored = stored
        self.last = self._given()

    def _given(self) -> dict[str, YamlValue]:
        stored = self.stored()
        return {each.name: stored.get(each.name, each.default) for each in FLOOR}

    def changed(self) -> tuple[Surface | None, int] | None:
        """Return surface (None: ideal) and seed if a parameter has changed since the last call, or None. Raises
        ConfigError if a new surface is not the name of a known one: a running base reads no other files."""
        given = self._given()
        if given == self.last:
            return None
        known = known_surfaces(resources.surfaces())
        if given['surface'] not in (*known, self.last['surface']):
            raise ConfigError(f"surface: {show(given['surface'])}: expected one of {', '.join(known)}")
        floor = read_floor(Section(given))
        self.last = given
        return floor


def read_floor(section: Section) -> tuple[Surface | None, int]:
    """Return the surface (None: ideal) and the seed of a simulated base. Raises ConfigError."""
    values = read(FLOOR, section)
    return values['surface'], values['seed']
