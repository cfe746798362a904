"""Sets the exit status of a script."""
from __future__ import annotations

from contextlib import contextmanager
import os
import traceback
from typing import Iterator

import rospy

from rbx1_nav.ros.node import life

PACKAGE = os.path.realpath(os.path.join(os.path.dirname(__file__), '..', '..')) + os.sep


@contextmanager
def exit_status() -> Iterator[None]:
    """Run a `with` block and exit the process.

    The exit status is 0, also after an interrupt; or the status of sys.exit(), whose text is logged; or 1 after an
    error, which is logged in one line. If the mistake is in the script itself, the line contains its position.
    """
    status = 0
    try:
        yield
    except SystemExit as error:
        status = error.code if isinstance(error.code, int) else int(error.code is not None)
        if isinstance(error.code, str):
            rospy.logerr('%s', error.code)
    except rospy.ROSInterruptException:     # shutdown was requested
        pass
    except (rospy.ROSException, ValueError, OSError) as error:  # StuckError; the master does not answer
        rospy.logerr('%s%s', error, position(error))
        status = 1
    life.leave(status)


def position(error: Exception) -> str:
    """Return the position of a mistake in a script as text, such as ' (square.py, line 21)'.

    It is empty for an error that rospy or this package has detected.
    """
    frames = [frame for frame in traceback.extract_tb(error.__traceback__) if frame.filename != __file__]
    if (not frames or isinstance(error, rospy.ROSException)
            or any(os.path.realpath(frame.filename).startswith(PACKAGE) for frame in frames)):
        return ''
    script = frames[0].filename
    line = [frame.lineno for frame in frames if frame.filename == script][-1]
    return f' ({os.path.basename(script)}, line {line})'
