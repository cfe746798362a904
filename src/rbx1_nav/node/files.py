"""Checks whether a file can be written, and writes files completely or not at all."""
from __future__ import annotations

import os
import shutil

from rbx1_nav.node.config import ConfigError


def check_writable(path: str) -> None:
    """Check that a file can be written. Raises ConfigError."""
    if not os.path.isdir(os.path.dirname(os.path.abspath(path))):
        raise ConfigError('expected a folder that exists')
    new = not os.path.lexists(path)
    try:
        open(path, 'ab').close()        # checking the permissions is not enough
        if new:
            os.remove(path)
    except OSError as error:
        raise ConfigError(f'expected a file that can be written: {error.strerror}') from error


def check_yaml(path: str) -> None:
    """Check that a YAML file can be written. Raises ConfigError."""
    if not path.endswith('.yaml'):
        raise ConfigError('expected a file name with the extension .yaml')
    check_writable(path)


def write_file(path: str, content: bytes) -> None:
    """Write a file atomically: after an error, the previous content is still there. Raises OSError."""
    path = os.path.realpath(path)       # do not replace a link to the file
    new = os.path.join(os.path.dirname(path), f'.rbx1_nav-{os.getpid()}.tmp')
    try:
        with open(new, 'wb') as file:
            file.write(content)
            file.flush()
            os.fsync(file.fileno())     # some file systems report a full disk only here
        if os.path.exists(path):
            shutil.copymode(path, new)
        os.replace(new, path)
    except OSError as error:    # a full disk names no file
        raise OSError(error.errno, error.strerror, path) from error
    finally:
        if os.path.exists(new):
            os.remove(new)
