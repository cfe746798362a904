"""Keeps a simulated clock in step with the nodes that drive by it.

A driver on simulated time answers each tick of the clock with one command. If the clock holds the next tick until that
command has arrived, a run has the same result on every machine and at every speed. A publisher that does not drive by
this clock (a person at a keyboard, another rate, wall time) never gives such an answer. Three rules detect it, once per
connection; from then on its commands take effect as they arrive.
"""
from collections import deque
from math import inf
from threading import Condition
from time import monotonic

COMMAND_TIMEOUT = 1.0   # s of wall time that a tick waits for its command
PROOF = 25              # ticks: a driver that has answered so many drives by this clock
PATIENCE = 5.0          # s of wall time that a tick waits for such a driver
FIRST_QUIET = 0.1       # s of wall time without a command that end a driver's first burst
QUIET = 0.03            # s, the same at the start of each later stream
SLOW_ANSWER = 0.05      # s of wall time: a later command may not be an answer to the tick at all
BURST_TIME = 1.0        # s of wall time: a burst answers at most the ticks of this time
MAX_BACKLOG = 25        # commands: more of them in the queue than at the start mean more than one per tick


class Driver:
    """One connection that brings commands."""

    def __init__(self, connection, name):
        self.connection = connection
        self.name = name
        self.queue = deque()        # one per tick; longer where the clock ran ahead of the driver at first
        self.received = 0
        self.heard_before = False
        self.lag = 0                # length of the queue when the stream began
        self.streaming = False      # its last command was a motion: the next tick will bring another
        self.answered = 0           # ticks, each with one command
        self.released = False       # does not drive by this clock

    @property
    def proven(self):
        """Whether it drives by this clock: what looks otherwise is a busy machine."""
        return self.answered >= PROOF


class Lockstep:
    """Applies one command per driver and tick: tuples that begin with linear (m/s) and angular (rad/s)."""

    def __init__(self, apply, warn, connected, unread, ended):
        """apply(command): puts a command in force; warn(text): logs a warning; connected(connection): whether a
        connection still exists; unread(connection): whether commands have come by it that are not received yet;
        ended(): whether not to wait any more."""
        self.apply = apply
        self.warn = warn
        self.connected = connected
        self.unread = unread
        self.ended = ended
        self.drivers = {}       # by the id of the connection, which the Driver keeps alive: so the id stays unique
        self.changed = Condition()
        self.ticks = deque()    # s of the monotonic clock: the ticks of the last BURST_TIME

    def receive(self, connection, name, command):
        """Accept a command that just arrived, in any thread. connection: any object; name: of the node that sent it."""
        with self.changed:
            driver = self.drivers.get(id(connection))
            if not driver:
                self.drivers = {key: each for key, each in self.drivers.items()
                                if each.queue or self.connected(each.connection)}
                driver = self.drivers[id(connection)] = Driver(connection, name)
            driver.received += 1
            if driver.released:
                self.apply(command)
            else:
                driver.queue.append(command)
            self.changed.notify()

    def collect(self):
        """Call before each tick: applies this tick's commands, and waits for those that are still to come."""
        with self.changed:
            now = monotonic()
            self.ticks.append(now)
            while self.ticks[0] < now - BURST_TIME:
                self.ticks.popleft()
            for driver in list(self.drivers.values()):
                if not driver.released:
                    self._collect_from(driver)

    def _collect_from(self, driver):
        if driver.queue and not driver.streaming:
            # the clock ran freely until now: let the driver answer all ticks that it has seen
            self._wait_until_quiet(driver, QUIET if driver.heard_before else FIRST_QUIET)
            driver.heard_before = True
            driver.lag = len(driver.queue)
            if driver.lag > len(self.ticks) + MAX_BACKLOG:
                self._release(driver, 'sends more than one command per tick')
        elif driver.streaming:
            start = monotonic()
            patience = PATIENCE if driver.proven else COMMAND_TIMEOUT
            if not self._wait_for(driver, lambda: driver.queue, patience):
                if not self.connected(driver.connection):
                    del self.drivers[id(driver.connection)]
                elif not self.ended():
                    self._release(driver, 'sent no command for a tick within %g s' % patience)
                return
            waited = monotonic() - start
            if waited > SLOW_ANSWER and not driver.proven:
                # a slow answer to this tick, or a stream that ignores the clock?
                self._wait_until_quiet(driver, 2 * waited)
        if driver.queue:
            command = driver.queue.popleft()
            linear, angular, *_ = command
            driver.streaming = 0 < abs(linear) < inf or 0 < abs(angular) < inf      # neither is true of nan
            driver.answered += driver.streaming and len(driver.queue) <= driver.lag
            self.apply(command)
        if len(driver.queue) > driver.lag + MAX_BACKLOG and not driver.proven:
            self._release(driver, 'sends more than one command per tick')

    def _wait_until_quiet(self, driver, quiet):
        """Hold the clock until the driver has sent nothing for `quiet` seconds of wall time."""
        deadline = monotonic() + (PATIENCE if driver.proven else max(COMMAND_TIMEOUT, 3 * quiet))
        while monotonic() < deadline and not self.ended():
            received = driver.received
            heard = self._wait_for(driver, lambda: driver.received > received, quiet)
            # unread: the thread that receives may not have had its turn
            if not heard and not self.unread(driver.connection):
                return
        if not (driver.proven or self.ended()):
            self._release(driver, 'sends commands while the clock is held')

    def _wait_for(self, driver, condition, timeout):
        """Wait until condition(), for at most `timeout` s of wall time, or until the driver has gone or all is to end.
        Returns condition()."""
        deadline = monotonic() + timeout
        while not condition() and self.connected(driver.connection) and not self.ended():
            left = deadline - monotonic()
            if left <= 0:
                break
            self.changed.wait(min(left, 0.1))
        return condition()

    def _release(self, driver, reason):
        driver.released = True
        self.warn('%s %s: the clock no longer waits for it, its commands take effect as they arrive'
                  % (driver.name, reason))
        if driver.queue:
            self.apply(driver.queue[-1])
            driver.queue.clear()
