"""Checks whether processes of this machine are asleep, and so have done the work for which they were woken.

On one machine, a message wakes its receiver before the sender continues (loopback TCP delivers within the sender's
call), and so do a notified condition and a released lock. So while anything is in transit between processes, at least
one of their threads is running or runnable. Sources: proc(5) and, for the clocks of other processes,
clock_getcpuclockid(3).
"""
from __future__ import annotations

import os
import socket
import time
from typing import Callable, Iterable, List, Optional, Tuple

# s: a thread that sleeps for less than this polls. On simulated time, ros::Rate sleeps for 1 ms at a time, which took
# up to 3.8 ms on a busy machine
POLL = 0.02
# the greatest number of processes with threads that poll at which it is usual that none of them has run during a check
AT_REST = 2
ENDED = b'X', b'Z'      # states of a thread that has exited
FUTEX, NANOSLEEP = b'futex_', b'hrtimer_nanosleep'
TIMED = b'sleep', b'poll', b'select'    # parts of the names of kernel functions that wait with a timeout
# first parts of the names of the kernel functions in which most threads wait, always in state S
INTERRUPTIBLE = FUTEX, b'poll_schedule_timeout', b'wait_woken', b'inet_csk_accept', NANOSLEEP


def _cpu_clock(number: int, of_thread: bool) -> int:
    """Return the id of the CPU time clock of a process or thread, for clock_gettime(2); it contains the number."""
    return ~number << 3 | (6 if of_thread else 2)


class Thread:
    """One thread of a process."""

    def __init__(self, folder: str, number: int) -> None:
        """folder: folder of the thread below /proc. Raises OSError if it has exited or must not be inspected."""
        self.clock = _cpu_clock(number, True)
        self.is_main = folder.split('/')[2] == str(number)
        self.files: list[int] = []
        self.ran: bytes | None = None       # how long and how often it has run
        self.changed = 0.0      # s of the monotonic clock: when a change of `ran` was last detected
        self.place = b'0'       # result of the last waits_in()
        self.is_poller = False  # whether it was found to wake by itself every few milliseconds
        try:
            for name in ('stat', 'wchan', 'schedstat'):
                self.files.append(os.open(folder + name, os.O_RDONLY))
            self.look()
        except OSError:
            self.close()
            raise

    def close(self) -> None:
        for file in self.files:
            os.close(file)
        self.files = []

    def look(self) -> bytes:
        """Update `ran` and return it."""
        ran = os.pread(self.files[2], 64, 0)
        if ran != self.ran:
            self.ran, self.changed = ran, time.monotonic()
        return ran

    def waits_in(self) -> bytes:
        """Return the name of the kernel function in which the thread waits; 0 if it is running or runnable."""
        self.place = os.pread(self.files[1], 64, 0)
        return self.place

    def sleeps(self) -> bool:
        """Return whether the thread is waiting or has exited."""
        if self.waits_in().startswith(INTERRUPTIBLE):
            return True
        # state S alone may belong to a thread that is about to wait and may still find that it need not wait
        state = self.state()
        return self.waits_in() != b'0' if state == b'S' else state in ENDED

    def state(self) -> bytes:
        """Return the letter of the state of the thread."""
        return os.pread(self.files[0], 512, 0).rpartition(b') ')[2][:1]     # the name in () may contain any characters

    def needs_no_message(self) -> bool:
        """Return whether the thread is running, runnable, or will wake by itself."""
        name = self.waits_in()
        return name == b'0' or any(part in name for part in TIMED)

    def runs(self) -> int:
        """Return how often the thread has run."""
        return int(self.look().split()[2])

    def polls(self) -> bool:
        """Return whether the thread is running or runnable, or sleeps only briefly; to be called after sleeps()."""
        if not (self.is_poller or self.place.startswith((b'0', NANOSLEEP))):
            return False
        now = time.monotonic()      # before the look: on a busy machine, the caller may be suspended in between
        self.look()
        self.is_poller = self.is_poller and now - self.changed < POLL
        return now - self.changed < POLL or self.waits_in() == b'0' and self.state() not in ENDED


Runs = List[Tuple[Thread, int]]     # how often threads have run
PollingThread = Tuple[Thread, Optional[bytes]]      # a Thread and its `ran`


class Process:
    """A process of this machine."""

    def __init__(self, pid: int, without: int | None = None) -> None:
        """pid: number of the process; without: number of a thread to ignore. Raises OSError if the process has exited
        or must not be inspected."""
        self.folder = f'/proc/{pid}/task/'
        self.clock = _cpu_clock(pid, False)
        self.without = without
        self.socket: socket.socket | None = None    # the connection by which it was found
        self.threads: dict[int, Thread] = {}       # by number
        self.new_threads = True
        self._update()
        if not self.threads:
            raise ProcessLookupError(f'no process {pid}')

    def close(self) -> None:
        for thread in self.threads.values():
            thread.close()
        self.threads = {}

    def activity(self, without_pollers: bool) -> object:
        """Return a value that changes when a thread runs, and is up to date for waiting threads. None if the process
        has exited. without_pollers: whether the threads that poll do not count."""
        try:
            if without_pollers and self.has_pollers():
                return [thread.look() for thread in self.threads.values() if not thread.is_poller]
            if self.without is None:
                return time.clock_gettime_ns(self.clock)
            # the clock of a process does not include the present run of a thread
            return sum(time.clock_gettime_ns(thread.clock) for thread in self.threads.values())
        except OSError:
            return None

    def cpu_time(self) -> int:
        """Return the CPU time that it has used, ns; 0 if it has exited."""
        try:
            return time.clock_gettime_ns(self.clock)
        except OSError:
            return 0

    def sleeps(self) -> bool:
        """Return whether all threads are asleep."""
        if os.stat(self.folder).st_nlink != len(self.threads) + 2 + (self.without is not None):
            self._update()
            return False
        return all(thread.sleeps() for thread in self.threads.values())

    def main_sleeps_briefly(self) -> bool:
        """Return whether the main thread will wake by itself, and does not poll the simulated time."""
        return bool(self.those(lambda thread: thread.is_main and not thread.is_poller and thread.needs_no_message()))

    def polling(self) -> list[PollingThread]:
        """Return the threads that sleep only briefly."""
        return [(thread, thread.ran) for thread in self.those(Thread.polls)]

    def has_pollers(self) -> bool:
        """Return whether there are threads that were found to wake by themselves."""
        return any(thread.is_poller for thread in self.threads.values())

    def has_new_threads(self) -> bool:
        """Return whether there are threads that did not exist at the last call."""
        new, self.new_threads = self.new_threads, False
        return new

    def runs(self) -> Runs:
        """Return how often each thread has run."""
        return runs_since((thread, 0) for thread in self.threads.values())

    def ended(self) -> bool:
        """Update the list of threads after one has exited; return whether all have exited."""
        self._update()
        return not self.threads

    def those(self, function: Callable[[Thread], object]) -> list[Thread]:
        """Call a function with each thread; return the threads for which it is true, without those that have exited."""
        found = []
        for thread in self.threads.values():
            try:
                if function(thread):
                    found.append(thread)
            except OSError:
                pass
        return found

    def _update(self) -> None:
        try:
            numbers = set(map(int, os.listdir(self.folder))) - {self.without}
        except (FileNotFoundError, ProcessLookupError):
            numbers = set()     # it has exited
        for number in self.threads.keys() - numbers:
            self.threads.pop(number).close()
        for number in numbers - self.threads.keys():
            try:
                self.threads[number] = Thread(f'{self.folder}{number}/', number)
                self.new_threads = True
            except (FileNotFoundError, ProcessLookupError):
                pass


class Network:
    """The kernel threads that deliver messages on a busy machine, instead of the sender."""

    def __init__(self) -> None:
        self.files: list[int] = []      # empty in a container, where these threads are invisible
        for pid in filter(str.isdigit, os.listdir('/proc')):
            try:
                with open(f'/proc/{pid}/comm', encoding='ascii') as file:
                    if file.read().startswith('ksoftirqd/'):
                        self.files.append(os.open(f'/proc/{pid}/stat', os.O_RDONLY))
            except (OSError, UnicodeDecodeError):
                pass

    def busy(self) -> bool:
        """Return whether messages may be in transit."""
        return any(b') R' in os.pread(file, 512, 0) for file in self.files)


def awake(processes: Iterable[Process], network: Network | None = None) -> Process | Network | None:
    """Return the first Process that is not asleep, or the Network if messages may be in transit between them; None if
    all of them were asleep at one moment, and nothing was in transit."""
    processes = list(processes)
    ignore = sum(process.has_pollers() for process in processes) > AT_REST
    # read for all before the first check: a checked process may be woken by another one that then sleeps when checked
    before = [process.activity(ignore) for process in processes]
    # not earlier: if no process has run since `before`, nothing can have been sent after this check
    if network and network.busy():
        return network
    # a second check finds what a thread that polls has woken after the first one
    for process in processes * (1 + ignore):
        try:
            if not process.sleeps():
                return process
        except OSError:
            if not process.ended():
                return process
    for process, activity in zip(processes, before):
        if process.activity(ignore) != activity and not process.ended():
            return process
    return None


def still_polling(threads: Iterable[PollingThread]) -> bool:
    """Return whether one of these threads, from Process.polling(), is still in the same sleep."""
    try:
        return any(thread.polls() and thread.ran == ran for thread, ran in threads)
    except OSError:     # it has exited
        return False


def runs_since(before: Iterable[tuple[Thread, int]]) -> Runs:
    """Return how often threads have run since then, without those that have exited."""
    runs = []
    for thread, count in before:
        try:
            runs.append((thread, thread.runs() - count))
        except (OSError, IndexError):       # IndexError: its files are closed
            pass
    return runs


class Pollers:
    """The threads that poll in some processes."""

    processes: dict[str, Process]       # by the name of the node

    def polling(self) -> list[PollingThread]:
        """Return the threads that poll the time instead of waiting for a message, as an argument for
        still_polling()."""
        return [each for process in self.processes.values() for each in process.polling()]

    def have_new_threads(self) -> bool:
        """Return whether there are new threads in the watched nodes since the last call."""
        return any([process.has_new_threads() for process in self.processes.values()])

    def runs(self) -> Runs:
        """Return how often each thread of the watched nodes has run."""
        return [each for process in self.processes.values() for each in process.runs()]

    @staticmethod
    def find_pollers(before: Runs) -> bool:
        """Look for threads that have run although nothing was delivered since runs(); return whether it is still
        uncertain for one of them."""
        runs = runs_since(before)
        for thread, count in runs:
            thread.is_poller = thread.is_poller or count > 1
        return any(count == 1 for _, count in runs)

    still_polling = staticmethod(still_polling)
