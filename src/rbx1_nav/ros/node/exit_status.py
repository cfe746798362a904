"""The exit status of a script."""
from __future__ import annotations

from contextlib import contextmanager
from typing import Iterator

import rospy

from rbx1_nav.ros.node import life


@contextmanager
def exit_status() -> Iterator[None]:
    """A `with` block after which the process ends: with status 0, also if it was interrupted, with that of sys.exit(),
    or, after one line that says what went wrong, with 1."""
    status = 0
    try:
        yield
    except SystemExit as error:
        status = error.code if isinstance(error.code, int) else int(error.code is not None)
    except rospy.ROSInterruptException:     # it was to end
        pass
    except (rospy.ROSException, ValueError, OSError) as error:  # StuckError; the master does not answer
        rospy.logerr('%s', error)
        status = 1
    life.leave(status)
