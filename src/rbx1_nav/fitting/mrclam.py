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
CAMERAS = 0.001, 0.001, 0.003   # m, m, rad: 1 sigma of the motion capture system, from robots that stand still

COMMANDS, TRUTH = '_Odometry.dat', '_Groundtruth.dat'   # ends of file names


def is_commands_file(path: str) -> bool:
    """Whether the name of a file is that of a robot's commands."""
    return path.endswith(COMMANDS)


def truth_file(path: str) -> str:
    """The path of the truth that belongs to the commands in `path`."""
    return path[:-len(COMMANDS)] + TRUTH


def read_table(path: str) -> Array:
    """The columns of a text file of numbers. Raises ConfigError."""
    try:
        with warnings.catch_warnings():
            warnings.simplefilter('ignore', UserWarning)    # a file without numbers: its columns are counted below
            table = numpy.loadtxt(path, ndmin=2)
    except (OSError, ValueError, UnicodeDecodeError) as error:
        raise ConfigError(f'{show_name(path)}: expected a text file of numbers: '
                          f"{' '.join(str(error).split())}") from error
    return table.T


def read_robot(commands: str, truth: str) -> Recording:
    """The Recording of two files: NAME_Odometry.dat has time (s), m/s and rad/s, as commanded; NAME_Groundtruth.dat has
    time (s), x and y (m), and heading (rad). Raises ConfigError."""
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
    """The Recordings of all robots of a set in a folder: D6R1_Odometry.dat and so on for set 6. Raises ConfigError."""
    pattern = f'D{number}R*{COMMANDS}'
    paths = sorted(glob.glob(os.path.join(glob.escape(folder), pattern)))
    if not paths:
        raise ConfigError(f'{show(folder)}: no files {pattern}: expected the folder of an unpacked set')
    return [read_robot(path, truth_file(path)) for path in paths]
