"""Reads the text files of the UTIAS Multi-Robot Cooperative Localization and Mapping Dataset (K. Y. K. Leung,
Y. Halpern, T. D. Barfoot, H. H. T. Liu, International Journal of Robotics Research 30(8), 969-974, 2011)."""
from __future__ import annotations

import glob
import os
import warnings

import numpy

from rbx1_nav.arrays import Array
from rbx1_nav.config import ConfigError, show, show_name
from rbx1_nav.fitting.recording import Commands, Recording, Track, check_recording

BASE_WIDTH = 0.26               # m, of a Create
CAMERAS = 0.001, 0.001, 0.003   # m, m, rad: 1 sigma of the motion capture system, from stationary robots

COMMANDS, TRUTH = '_Odometry.dat', '_Groundtruth.dat'   # suffixes of file names


def is_commands_file(path: str) -> bool:
    """Return whether a file contains the commands of a robot, according to its name."""
    return path.endswith(COMMANDS)


def truth_file(path: str) -> str:
    """Return the path of the truth file that belongs to the commands file `path`."""
    return path[:-len(COMMANDS)] + TRUTH


def read_table(path: str) -> Array:
    """Return the columns of a text file of numbers. Raises ConfigError."""
    try:
        with warnings.catch_warnings():
            warnings.simplefilter('ignore', UserWarning)    # a file without numbers: its columns are counted below
            table = numpy.loadtxt(path, ndmin=2)
    except (OSError, ValueError, UnicodeDecodeError) as error:
        raise ConfigError(f'{show_name(path)}: expected a text file of numbers: '
                          f"{' '.join(str(error).split())}") from error
    return table.T


def read_robot(commands: str, truth: str) -> Recording:
    """Read a Recording from two files. Raises ConfigError.

    NAME_Odometry.dat contains time (s) and commanded m/s and rad/s; NAME_Groundtruth.dat contains time (s), x and y
    (m), and heading (rad).
    """
    tables = []
    for path, width in ((commands, 3), (truth, 4)):
        table = read_table(path)
        if len(table) != width:
            raise ConfigError(f'{show_name(path)}: {len(table) if table.size else 0} columns: expected {width}')
        tables.append(table)
    name = os.path.basename(commands).replace(COMMANDS, '')
    track = Track(*tables[1])
    recording = check_recording(Recording(name, Commands(*tables[0]), None, None, track, None))
    return recording._replace(truth=track._replace(yaw=numpy.unwrap(track.yaw)))


def read_set(folder: str, number: int) -> list[Recording]:
    """Read the Recordings of all robots of a set from a folder: for set 6, D6R1_Odometry.dat and so on. Raises
    ConfigError."""
    pattern = f'D{number}R*{COMMANDS}'
    paths = sorted(glob.glob(os.path.join(glob.escape(folder), pattern)))
    if not paths:
        raise ConfigError(f'{show(folder)}: no files {pattern}: expected the folder of an unpacked set')
    return [read_robot(path, truth_file(path)) for path in paths]
