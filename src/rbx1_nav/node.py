"""How a node begins and ends, so that nothing hangs: not on a lock that a signal interrupted, not on a master.

Signals never interrupt the main thread: a thread waits for them and sets `end_requested`, as does every other way to end a
node. The main thread looks at it, does its last duty, and calls leave().
"""
import logging
import logging.handlers
import os
import queue
import signal
import sys
import threading
import time

import rospy
from rospy.impl.rosout import RosOutHandler

LINGER = 1.4        # s of wall time from the request to end to the end of the process, whatever hangs
GOODBYE = 0.25      # s of wall time for the master to hear of it

LONGEST_SLEEP = 0.05    # s

end_requested = threading.Event()
_leaving = threading.Event()


def init_node(name):
    """Become the node `name`. Ctrl-C, kill, a closed terminal and `rosnode kill` set end_requested.

    Raises ROSInterruptException if that comes before the node is registered.
    """
    read_end, write_end = os.pipe()
    os.set_blocking(write_end, False)
    signal.set_wakeup_fd(write_end)     # a signal writes to the pipe; the handler itself has nothing to do
    for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
        if number != signal.SIGHUP or signal.getsignal(number) is not signal.SIG_IGN:   # nohup means it
            signal.signal(number, lambda *_: None)
    threading.Thread(target=_wait_for_signal, args=(read_end,), daemon=True).start()
    rospy.on_shutdown(_request_end)
    try:
        rospy.init_node(name, disable_signals=True)
    except rospy.ROSInitException:
        if end_requested.is_set():
            raise rospy.ROSInterruptException('asked to end')
        raise
    _decouple_rosout()


def _wait_for_signal(pipe):
    os.read(pipe, 1)
    _end_anyway()
    rospy.signal_shutdown('signal')


def _end_anyway():
    last_resort = threading.Timer(LINGER, os._exit, [1])
    last_resort.daemon = True
    last_resort.start()


def _request_end():
    """Runs in whatever thread ends the node; publishers are open until it returns."""
    _end_anyway()
    end_requested.set()
    _leaving.wait(LINGER)


def sleep(seconds):
    """Sleep for so many seconds of wall time, or for LONGEST_SLEEP: call it in a loop that looks at end_requested.

    Not end_requested.wait(), which before Python 3.11 follows a system clock that is stepped.
    """
    time.sleep(max(0, min(seconds, LONGEST_SLEEP)))


def leave(status):
    """End the process with an exit status. Tells the master, but does not wait for one that hangs."""
    _leaving.set()
    threading.Thread(target=rospy.signal_shutdown, args=('done',), daemon=True).start()
    give_up = time.monotonic() + GOODBYE
    while not rospy.is_shutdown() and time.monotonic() < give_up:
        time.sleep(0.01)
    try:
        sys.stdout.flush()
        sys.stderr.flush()
    finally:    # the terminal may be gone
        os._exit(status)


def _decouple_rosout():
    """Let a thread of its own pass on to /rosout what the node says; what is printed is not touched.

    rospy asks the master for a parameter on the way there, so a master that hangs would hang whoever says something.
    """
    logger = logging.getLogger('rosout')
    for handler in [each for each in logger.handlers if isinstance(each, RosOutHandler)]:
        records = queue.SimpleQueue()
        logger.removeHandler(handler)
        logger.addHandler(logging.handlers.QueueHandler(records))
        logging.handlers.QueueListener(records, handler).start()
