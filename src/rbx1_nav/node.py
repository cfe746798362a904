"""How a node begins and ends, so that nothing hangs: not on a lock that a signal interrupted, not on a master.

Signals never interrupt the main thread: a thread waits for them and sets `end_requested`, as does every other way to end a
node. The main thread looks at it, does its last duty, and calls leave().
"""
import os
import signal
import sys
import threading
import time

import rosgraph
import rospy
from rospy.impl.paramserver import get_param_server_cache

LINGER = 1.4        # s of wall time from the request to end to the end of the process, whatever hangs
GOODBYE = 0.25      # s of wall time for the master to hear of it

LONGEST_SLEEP = 0.05    # s

end_requested = threading.Event()
_leaving = threading.Event()


class _Terminal:
    """A stream to somebody who may leave: a closed terminal or a broken pipe is no reason to stop in mid-sentence."""

    def __init__(self, stream):
        self._stream = stream

    def __getattr__(self, name):
        return getattr(self._stream, name)

    def write(self, text):
        """Write, or swallow it."""
        self._try(self._stream.write, text)
        return len(text)

    def flush(self):
        """Flush, or forget it."""
        self._try(self._stream.flush)

    def _try(self, function, *args):
        try:
            function(*args)
        except OSError:
            os.dup2(os.open(os.devnull, os.O_WRONLY), self._stream.fileno())


def init_node(name):
    """Become the node `name`. Ctrl-C, kill, a closed terminal and `rosnode kill` set end_requested.

    Raises ROSInterruptException if that comes before the node is registered, ROSException if the master hangs up.
    """
    read_end, write_end = os.pipe()
    os.set_blocking(write_end, False)
    signal.set_wakeup_fd(write_end)     # a signal writes to the pipe; the handler itself has nothing to do
    for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
        if number != signal.SIGHUP or signal.getsignal(number) is not signal.SIG_IGN:   # nohup means it
            signal.signal(number, lambda *_: None)
    threading.Thread(target=_wait_for_signal, args=(read_end,), daemon=True).start()
    rospy.on_shutdown(_request_end)
    sys.stdout, sys.stderr = _Terminal(sys.stdout), _Terminal(sys.stderr)
    try:
        rospy.init_node(name, disable_signals=True)
    except (OSError, rospy.ROSInitException) as error:
        if not end_requested.is_set():
            raise rospy.ROSException('No answer from the master at %s (%s): expected a running roscore'
                                     % (rosgraph.get_master_uri(), error))
    if end_requested.is_set():
        raise rospy.ROSInterruptException('asked to end')
    # Whatever is said goes to /rosout, and for each line rospy asks the master for this parameter. One that hangs would
    # hang the node; one that has given our name to another node would take that for our return. So it is answered here.
    get_param_server_cache().set('/rosout_disable_topics_generation', False)


def _wait_for_signal(pipe):
    os.read(pipe, 1)
    _set_end_requested()


def _set_end_requested():
    end_requested.set()
    last_resort = threading.Timer(LINGER, os._exit, [1])
    last_resort.daemon = True
    last_resort.start()


def _request_end():
    """What rospy calls when it is told to end, in some thread of its own; publishers are open until it returns."""
    _set_end_requested()
    _leaving.wait(LINGER)


def sleep(seconds):
    """Sleep for so many seconds of wall time, or for LONGEST_SLEEP: call it in a loop that looks at end_requested.

    Not end_requested.wait(), which before Python 3.11 follows a system clock that is stepped.
    """
    time.sleep(max(0, min(seconds, LONGEST_SLEEP)))


def leave(status):
    """End the process with an exit status. Tells the master, but does not wait for one that hangs."""
    time.sleep(0.02)    # for the last words to leave for /rosout
    _leaving.set()
    threading.Thread(target=rospy.signal_shutdown, args=('done',), daemon=True).start()
    give_up = time.monotonic() + GOODBYE
    while not rospy.is_shutdown() and time.monotonic() < give_up:
        time.sleep(0.01)
    sys.stdout.flush()
    sys.stderr.flush()
    os._exit(status)


def run(main):
    """Run main(), which makes a node and returns its exit status, and end the process with that."""
    try:
        status = main()
    except rospy.ROSInterruptException:     # before it began
        status = 0
    except rospy.ROSException as error:
        rospy.logfatal('%s', error)
        status = 1
    leave(status)
