"""Keeps a simulated clock in step with those who drive on it.

Whoever drives on simulated time answers each tick of the clock with one command. Hold the next tick until that command
is there, and the run comes out the same on every machine and at any speed. Somebody who does not drive
by this clock (a person at a keyboard, another rate, wall time) gives no answer to wait for; three rules find them out,
once for a connection, and their commands take effect as they arrive from then on.
"""
from collections import deque
from threading import Condition
from time import monotonic

PATIENCE = 1.0      # s of wall time that a tick waits for its command
FIRST_SILENCE = 0.1 # s of wall time after which a driver has said what it had to say, when it is heard for the first time
SILENCE = 0.03      # s, the same at the start of each later stream
SLOW = 0.05         # s of wall time: an answer that takes longer makes one wonder whether it is one
DEPTH = 25          # commands: so many more waiting than at the start of the stream mean more than one for each tick


class Driver:
    """One connection that brings commands."""

    def __init__(self, connection, name):
        self.connection = connection
        self.name = name
        self.waiting = deque()      # one for each tick; more than one where the clock ran ahead of it at first
        self.received = 0
        self.met = False            # whether it has been heard before
        self.lag = 0                # commands that were waiting when the stream began
        self.streaming = False      # its last command was to move: the next tick will bring another
        self.free = False           # does not drive by this clock


class Lockstep:
    """Hands out one command for each driver and tick: tuples that begin with linear in m/s and angular in rad/s."""

    def __init__(self, apply, say):
        """apply(command): puts a command in force; say(text): tells the reader."""
        self.apply = apply
        self.say = say
        self.drivers = {}       # by the id of their connection, which they hold: so no other object gets that id
        self.changed = Condition()

    def knows(self, connection):
        """Whether a command has come by this connection (any object)."""
        return id(connection) in self.drivers

    def keep(self, connections):
        """Forget all drivers but those of these connections."""
        with self.changed:
            live = set(map(id, connections))
            self.drivers = {key: driver for key, driver in self.drivers.items() if key in live}

    def receive(self, connection, name, command):
        """Take a command that just arrived, from any thread. connection: any object; name: the node behind it."""
        with self.changed:
            driver = self.drivers.setdefault(id(connection), Driver(connection, name))
            driver.received += 1
            if driver.free:
                self.apply(command)
            else:
                driver.waiting.append(command)
            self.changed.notify()

    def collect(self):
        """Call before each tick: applies this tick's commands, and waits for those that are still to come."""
        with self.changed:
            for driver in list(self.drivers.values()):
                if not driver.free:
                    self._collect_from(driver)

    def _collect_from(self, driver):
        if driver.waiting and not driver.streaming:
            # the clock ran freely before: let it say what it has to say to the ticks that it has seen
            self._let_settle(driver, SILENCE if driver.met else FIRST_SILENCE)
            driver.met = True
            driver.lag = len(driver.waiting)
        elif driver.streaming:
            start = monotonic()
            if not self.changed.wait_for(lambda: driver.waiting, PATIENCE):
                self._set_free(driver, 'left a tick without a command for %g s' % PATIENCE)
            waited = monotonic() - start
            if not driver.free and waited > SLOW:
                # so late: is it a slow answer to this tick, or does it not look at the clock at all?
                self._let_settle(driver, 2 * waited)
        if driver.waiting:
            command = driver.waiting.popleft()
            linear, angular, *_ = command
            driver.streaming = linear != 0 or angular != 0
            self.apply(command)
        if len(driver.waiting) > driver.lag + DEPTH:
            self._set_free(driver, 'sends more than one command in a tick')

    def _let_settle(self, driver, silence):
        """Let the clock stand until the driver has been silent for so many seconds of wall time."""
        give_up = monotonic() + max(PATIENCE, 3 * silence)
        while monotonic() < give_up:
            heard = driver.received
            if not self.changed.wait_for(lambda: driver.received > heard, silence):
                return
        self._set_free(driver, 'sends commands while the clock stands still')

    def _set_free(self, driver, reason):
        driver.free = True
        self.say('%s %s: the clock no longer waits for it, its commands take effect as they arrive'
                 % (driver.name, reason))
        if driver.waiting:
            self.apply(driver.waiting[-1])
            driver.waiting.clear()
