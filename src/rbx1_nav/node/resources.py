"""Finds the files of this package, in a source tree and in an install space."""
from __future__ import annotations

import os

import rospkg

from rbx1_nav.node.config import ConfigError


def path(*parts: str) -> str:
    """Return the path of a file or folder of this package. Raises ConfigError."""
    try:
        return os.path.join(rospkg.RosPack().get_path('rbx1_nav'), *parts)
    except rospkg.ResourceNotFound:
        raise ConfigError("rbx1_nav: not found: expected a terminal in which the workspace's setup.bash "
                          'was sourced') from None


def surfaces() -> str:
    """Return the folder of the surface files of this package."""
    return path('config', 'surfaces')
