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
from typing import Any, Iterable

# s: a thread that sleeps for less than this polls. On simulated time, ros::Rate sleeps for 1 ms at a time, which took
# up to 3.8 ms on a busy machine
POLL = 0.02
# the greatest number of processes with threads that poll at which it is usual that none of them has run during a check
AT_REST = 2
ENDED = b'X', b'Z'      # states of a thread that has exited
NANOSLEEP = b'hrtimer_nanosleep'
# first parts of the names of the kernel functions in which most threads wait, always in state S
INTERRUPTIBLE = b'futex_', b'poll_schedule_timeout', b'wait_woken', b'inet_csk_accept', NANOSLEEP
TIMED = b'sleep', b'poll', b'select'    # parts of the names of kernel functions that wait with a timeout


def _cpu_clock(number: int, of_thread: bool) -> int:
    """Return the id of the CPU time clock of a process or thread, for clock_gettime(2); it contains the number."""
    return ~number << 3 | (6 if of_thread else 2)


class Thread:
    """One thread of a process."""

    def __init__(self, folder: str, number: int) -> None:
        """folder: folder of the thread below /proc. Raises OSError if it has exited or must not be inspected."""
        self.clock = _cpu_clock(number, True)
        self.files: list[int] = []
        self.ran: bytes | None = None       # how long and how often it has run
        self.changed = 0.0      # s of the monotonic clock: when a change of `ran` was last detected
        self.place = b'0'       # result of the last waits_in()
        self.is_poller = False  # whether it was found to wake by itself every few milliseconds
        for name in ('stat', 'wchan', 'schedstat'):
            self.files.append(os.open(folder + name, os.O_RDONLY))
        self.look()

    def __del__(self) -> None:
        for file in self.files:
            os.close(file)

    def _read(self, number: int) -> bytes:
        """Return the content of a file; nothing if the thread has exited."""
        try:
            return os.pread(self.files[number], 512, 0)
        except OSError:
            return b''

    def look(self) -> bytes:
        """Update `ran` and return it."""
        ran = self._read(2)
        if ran != self.ran:
            self.ran, self.changed = ran, time.monotonic()
        return ran

    def waits_in(self) -> bytes:
        """Return the name of the kernel function in which the thread waits; 0 if it is running or runnable."""
        self.place = self._read(1)
        return self.place

    def sleeps(self) -> bool:
        """Return whether the thread is waiting. Raises OSError if it has gone: another one may have taken its place."""
        self.place = os.pread(self.files[1], 64, 0)
        if self.place.startswith(INTERRUPTIBLE):
            return True
        state = self.state()
        # state S alone may belong to a thread that is about to wait and may still find that it need not wait
        return self.waits_in() not in (b'0', b'') if state == b'S' else state in ENDED

    def state(self) -> bytes:
        """Return the letter of the state of the thread."""
        return self._read(0).rpartition(b') ')[2][:1]     # the name in () may contain any characters

    def runs(self) -> int:
        """Return how often the thread has run; 0 if it has exited."""
        fields = self.look().split()
        return int(fields[2]) if fields else 0

    def polls(self) -> bool:
        """Return whether the thread is running or runnable, or sleeps only briefly; to be called after sleeps()."""
        if not (self.is_poller or self.place.startswith((b'0', NANOSLEEP))):
            return False
        now = time.monotonic()      # before the look: on a busy machine, the caller may be suspended in between
        exists = bool(self.look()) and self.state() not in ENDED
        self.is_poller = self.is_poller and now - self.changed < POLL
        return exists and (now - self.changed < POLL or self.waits_in() == b'0')


class Process:
    """A process of this machine."""

    def __init__(self, pid: int, without: int | None = None) -> None:
        """pid: number of the process; without: number of a thread to ignore. Raises OSError if the process has exited
        or must not be inspected."""
        self.folder = f'/proc/{pid}/task/'
        self.clock = _cpu_clock(pid, False)
        self.without = without
        self.socket: socket.socket | None = None    # the connection by which it was found
        self.main = Thread(f'{self.folder}{pid}/', pid)
        self.threads = {pid: self.main} if pid != without else {}       # by number
        self.new_threads = True     # whether there are threads that find_pollers() has not seen
        self.ended()

    def activity(self, without_pollers: bool = False) -> Any:
        """Return a value that changes when a thread runs, and is up to date for waiting threads. None if the process
        has exited. without_pollers: whether the threads that poll do not count; otherwise, it is a CPU time, ns."""
        try:
            if without_pollers and self.has_pollers():
                return [thread.look() for thread in self.threads.values() if not thread.is_poller]
            if self.without is None:
                return time.clock_gettime_ns(self.clock)
            # the clock of a process does not include the present run of a thread
            return sum(time.clock_gettime_ns(thread.clock) for thread in self.threads.values())
        except OSError:
            return None

    def sleeps(self) -> bool:
        """Return whether all threads are asleep or have exited."""
        try:
            if os.stat(self.folder).st_nlink == len(self.threads) + 2 + (self.without is not None):
                return all(thread.sleeps() for thread in self.threads.values())
        except OSError:
            pass
        return self.ended()     # which updates the list of threads

    def has_pollers(self) -> bool:
        """Return whether there are threads that were found to wake by themselves."""
        return any(thread.is_poller for thread in self.threads.values())

    def naps(self) -> bool:
        """Return whether the main thread is running or will wake by itself, but not to look at the time again and
        again."""
        name = b'' if self.main.is_poller else self.main.waits_in()
        return name == b'0' or any(part in name for part in TIMED)

    def main_runs(self, longer_than: float) -> int:
        """Return how often the main thread has run; 0 if it has not waited for longer than so many s since."""
        runs = self.main.runs()
        return runs if time.monotonic() - self.main.changed > longer_than else 0

    def ended(self) -> bool:
        """Update the list of threads; return whether all have exited."""
        try:
            numbers = set(map(int, os.listdir(self.folder))) - {self.without}
        except (FileNotFoundError, ProcessLookupError):
            numbers = set()     # it has exited
        for number in self.threads.keys() - numbers:
            del self.threads[number]
        for number in numbers - self.threads.keys():
            try:
                self.threads[number] = Thread(f'{self.folder}{number}/', number)
                self.new_threads = True
            except (FileNotFoundError, ProcessLookupError):
                pass
        return not self.threads


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


def find_awake(processes: Iterable[Process], network: Network | None = None) -> Process | Network | None:
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
        if not process.sleeps():
            return process
    for process, activity in zip(processes, before):
        if process.activity(ignore) != activity and not process.ended():
            return process
    return None


def polling(processes: Iterable[Process]) -> list[tuple[Thread, bytes | None]]:
    """Return the threads that sleep only briefly, each with its `ran`: they poll the time."""
    return [(thread, thread.ran) for process in processes for thread in process.threads.values() if thread.polls()]


def still_polling(threads: list[tuple[Thread, bytes | None]]) -> bool:
    """Return whether one of these threads, from polling(), is still in the same sleep."""
    return any(thread.polls() and thread.ran == ran for thread, ran in threads)


def find_pollers(processes: Iterable[Process]) -> None:
    """Find the threads that run more than once while nothing is delivered, which takes POLL."""
    before = []
    for process in processes:
        process.new_threads = False
        before += [(thread, thread.runs()) for thread in process.threads.values()]
    time.sleep(POLL)
    for thread, runs in before:
        thread.is_poller = thread.is_poller or thread.runs() > runs + 1
