"""Starts and stops a node without hanging on the master or on a lock that a signal has interrupted.

Signals never interrupt the main thread. A thread waits for them and sets `end_requested`; so does every other kind of
shutdown request. The main thread checks it, does its final work, and calls leave(). A driving script is plain rospy
instead: see rbx1_nav/driving/script.py. docs/decisions/nodes.md explains why.
"""
from __future__ import annotations

from contextlib import suppress
from math import inf
import os
import signal
import sys
import threading
import time
from typing import Any, Callable, NoReturn, Sequence, TextIO, TypeVar, cast

import rosgraph
import rospy
import rospy.impl.masterslave
from rospy.impl.paramserver import get_param_server_cache

from rbx1_nav.node.addresses import check_master_uri, check_own_address
from rbx1_nav.node.config import ConfigError, YamlValue
from rbx1_nav.node.master import require_master
from rbx1_nav.node.parameters import Parameter, list_parameters
from rbx1_nav.node.private_parameters import (
    check_before_start, check_command_line, future_name, load_params, read_wait_timeout, report_parameters,
    stored_params)
from rbx1_nav.node.rospy_connections import repair_connections

EXIT_DEADLINE = 1.4         # s of wall time from the request to the exit of the process, whatever hangs
UNREGISTER_TIMEOUT = 0.25   # s of wall time for the master to unregister the node
SIGNALS = signal.SIGINT, signal.SIGTERM, signal.SIGHUP
MAX_SLEEP = 0.05            # s, also between two calls to a master that is not running yet

# rospy of Debian 11 calls Thread.isAlive() on shutdown, which Python 3.9 has removed
if not hasattr(threading.Thread, 'isAlive'):
    setattr(threading.Thread, 'isAlive', threading.Thread.is_alive)

Found = TypeVar('Found')
end_requested = threading.Event()
exit_status = [1]       # of a process that does not exit in time
_init_node, _is_shutdown = rospy.init_node, rospy.is_shutdown


class _Terminal:
    """An output stream that survives a closed terminal or a broken pipe."""

    def __init__(self, stream: TextIO) -> None:
        self._stream = stream

    # Any: attributes of the stream
    def __getattr__(self, name: str) -> Any:
        return getattr(self._stream, name)

    def write(self, text: str) -> int:
        """Write the text, or drop it if that fails."""
        self._try(self._stream.write, text)
        return len(text)

    def flush(self) -> None:
        self._try(self._stream.flush)

    def _try(self, function: Callable[..., object], *args: str) -> None:
        try:
            function(*args)
        except OSError:
            os.dup2(os.open(os.devnull, os.O_WRONLY), self._stream.fileno())


def init_node(name: str, usage: str, parameters: Sequence[Parameter] = (), requires_master: bool = False,
              check: Callable[[dict[str, YamlValue]], object] | None = None, wall_time: bool = False,
              on_signal: Callable[[int], object] | None = None, **options: Any) -> None:
    """Start the node `name`. From here on, Ctrl-C, kill, a closed terminal and `rosnode kill` set end_requested.

    usage: printed with the list of parameters for --help and for an invalid command line; in both cases, the process
    exits. '' for a program that reads its command line itself.
    parameters: the parameters of the node. They are checked before the node can shut down an older one with the same
    name, and are then read with param() of private_parameters.py.
    requires_master: whether a master that does not answer is an error. Otherwise the node waits for it, for at most
    ~wait_timeout if it has this parameter.
    check(params): raises ConfigError for private parameters that are inconsistent.
    wall_time: whether to use the wall clock even in simulated time; the node then does not subscribe to /clock.
    on_signal(number): called in a thread, in place of request_end().
    options: further arguments of rospy.init_node.
    Raises ROSInterruptException if shutdown is requested before the node is registered, and ROSException if the master
    does not answer or a parameter is invalid.
    """
    names = [each.name for each in parameters]
    # cast, because only the wrapped stream has the other methods of TextIO
    sys.stdout, sys.stderr = cast(TextIO, _Terminal(sys.stdout)), cast(TextIO, _Terminal(sys.stderr))
    if usage:
        check_command_line(f'{usage.strip()}\n\n{list_parameters(parameters)}'.strip(), names)
    check_master_uri()
    check_own_address(future_name(name))
    if requires_master:
        require_master()
    take = on_signal or request_end
    setattr(rospy.impl.masterslave, 'signal_shutdown', lambda _: take(signal.SIGTERM))      # `rosnode kill`
    if on_signal is None:
        rospy.on_shutdown(request_end)      # rospy itself gives up, such as after a failure of its server
    _take_signals(take, options.pop('disable_signals', False))
    wait_for_master(name, parameters)
    if not end_requested.is_set():
        check_before_start(name, parameters, check)
    check_end()
    repair_connections()
    try:
        _init_node(name, disable_signals=True, **{'disable_rostime': wall_time, **options})
    except (OSError, rospy.ROSInitException) as error:
        if not end_requested.is_set():
            raise rospy.ROSException(f'The master at {rosgraph.get_master_uri()} does not answer ({error}): '
                                     'expected a running roscore') from error
    check_end()
    # For each logged line, rospy queries this parameter from the master. A frozen master would block the node, and a
    # master that has given the name to another node would register this one again. The cached value avoids the call.
    get_param_server_cache().set('/rosout_disable_topics_generation', False)
    stored = stored_params()
    if usage:
        report_parameters(stored, names)
    load_params(parameters, stored)


def wait_for_master(name: str, parameters: Sequence[Parameter]) -> None:
    """Wait until the master answers, or shutdown is requested, and log one line if it does not answer immediately.

    name, parameters: of the node; the limit is ~wait_timeout, if it has this parameter. Raises ROSException after it.
    """
    uri, end = rosgraph.get_master_uri(), None
    while not end_requested.is_set():
        try:
            return require_master()
        except Exception:       # another server at this port causes other errors
            if end is None:
                # as init_node() would, so that the line has the usual format
                rospy.core.configure_logging(future_name(name))
                limit = read_wait_timeout(name, parameters)
                end = time.monotonic() + (inf if limit is None else limit)
                rospy.loginfo('Waiting for the master at %s', uri)
        if time.monotonic() > end:
            raise rospy.ROSException(f'The master at {uri} does not answer (timed out after {limit:g} s): '
                                     'expected a running roscore')
        sleep(MAX_SLEEP)


def _take_signals(on_signal: Callable[[int], object], disabled: bool) -> None:
    """disabled: whether the program handles signals itself: Ctrl-C is a KeyboardInterrupt, and its handlers stay."""
    if disabled and threading.current_thread() is not threading.main_thread():      # which alone can take signals
        return
    read_end, write_end = os.pipe()
    os.set_blocking(write_end, False)
    signal.set_wakeup_fd(write_end)     # a signal writes its number to the pipe

    def pass_on(number: int, _: object) -> None:
        """Handle a signal: a library may have taken the wakeup_fd, such as asyncio or matplotlib's windows."""
        with suppress(BlockingIOError):
            os.write(write_end, bytes([number]))

    def leave_to_child() -> None:
        """In a child process, handle signals as usual: multiprocessing ends its processes with SIGTERM."""
        signal.set_wakeup_fd(-1)
        for number in SIGNALS:
            if signal.getsignal(number) is pass_on:
                signal.signal(number, signal.SIG_DFL)
    os.register_at_fork(after_in_child=leave_to_child)
    for number in SIGNALS:
        handler = signal.getsignal(number)
        if not (handler is signal.SIG_IGN and number == signal.SIGHUP       # as under nohup
                or disabled and handler is not signal.SIG_DFL):
            signal.signal(number, signal.default_int_handler if disabled and number == signal.SIGINT else pass_on)

    def wait() -> None:
        while True:
            number = os.read(read_end, 1)[0]
            if signal.getsignal(number) is pass_on:     # not a handler of the program, such as for SIGALRM
                on_signal(number)
    threading.Thread(target=wait, daemon=True).start()


def request_end(_: int = 0) -> None:
    """Set end_requested. The process exits within EXIT_DEADLINE."""
    end_requested.set()
    last_resort = threading.Timer(EXIT_DEADLINE, lambda: os._exit(exit_status[0]))
    last_resort.daemon = True
    last_resort.start()


def sleep(seconds: float) -> None:
    """Sleep for `seconds` of wall time, at most MAX_SLEEP. To be called in a loop that checks end_requested.

    end_requested.wait() is unsuitable: before Python 3.11 it follows steps of the system clock.
    """
    time.sleep(max(0, min(seconds, MAX_SLEEP)))


def check_end() -> None:
    """Raise ROSInterruptException if shutdown is requested."""
    if end_requested.is_set():
        raise rospy.ROSInterruptException('shutdown requested')


def wait_for(find: Callable[[], Found | None], timeout: float, missing: Callable[[], str]) -> Found:
    """Call find() every 20 ms until it does not return None, and return its result.

    missing(): returns what is missing, for the log. Raises ROSException after `timeout` s of wall time, and
    ROSInterruptException as soon as shutdown is requested.
    """
    deadline, log_time = time.monotonic() + timeout, time.monotonic() + 0.5
    while True:
        found = find()
        if found is not None:
            return found
        if time.monotonic() > deadline:
            raise rospy.ROSException(f'Timed out after {timeout:g} s waiting for {missing()}')
        if time.monotonic() > log_time:
            log_time += 5
            rospy.loginfo('Waiting for %s', missing())
        sleep(0.02)
        check_end()


def wait_for_shutdown() -> None:
    """Wait until rospy has unregistered the node, for at most UNREGISTER_TIMEOUT, and flush the output."""
    give_up = time.monotonic() + UNREGISTER_TIMEOUT
    while not _is_shutdown() and time.monotonic() < give_up:
        time.sleep(0.01)
    sys.stdout.flush()
    sys.stderr.flush()


def leave(status: int) -> NoReturn:
    """Unregister the node and exit with a status, without waiting for a master that hangs."""
    exit_status[0] = status    # the final work is done
    time.sleep(0.02)    # lets the last line reach /rosout
    threading.Thread(target=rospy.signal_shutdown, args=('done',), daemon=True).start()
    wait_for_shutdown()
    os._exit(status)


def run(main: Callable[[], int]) -> NoReturn:
    """Run main(), which starts a node and returns an exit status, and exit with this status."""
    try:
        status = main()
    except rospy.ROSInterruptException:     # before the node was registered
        status = 0
    except ConfigError as error:        # in a parameter
        rospy.logfatal('%s/%s', rospy.get_name(), error)
        status = 1
    except rospy.ROSException as error:
        rospy.logfatal('%s', error)
        status = 1
    except OSError as error:
        rospy.logfatal('The master at %s does not answer (%s)', rosgraph.get_master_uri(), error)
        status = 1
    leave(status)
