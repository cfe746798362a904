"""Sets the exit status of a script."""
from __future__ import annotations

from contextlib import contextmanager
from typing import Iterator

import rospy

from rbx1_nav.ros.node import life


@contextmanager
def exit_status() -> Iterator[None]:
    """Run a `with` block and exit the process.

    The exit status is 0, also after an interrupt; or the status of sys.exit(); or 1 after an error, which is logged in
    one line.
    """
    status = 0
    try:
        yield
    except SystemExit as error:
        status = error.code if isinstance(error.code, int) else int(error.code is not None)
    except rospy.ROSInterruptException:     # shutdown was requested
        pass
    except (rospy.ROSException, ValueError, OSError) as error:  # StuckError; the master does not answer
        rospy.logerr('%s', error)
        status = 1
    life.leave(status)
