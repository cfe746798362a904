"""Keeps a simulated clock in step with the nodes that use it to drive, whatever they wait for.

The base delivers the messages of a tick one topic after another, and the clock last. After each of them, it waits until
every process that the message may have woken is asleep again. So a node that wakes at a tick finds all messages of the
tick, and its commands have arrived before the next tick begins. The result does not depend on the machine.

A node that something else wakes, such as the wall clock, is found by a test: now and then, the clock is held for a
while when everything is asleep. A command that arrives then was not prompted by a message of the base.
"""
from __future__ import annotations

from collections import Counter
from io import BytesIO
from threading import Lock
from time import monotonic, sleep
from typing import Any, Callable, NamedTuple

from genpy import Message
from rosgraph_msgs.msg import Clock
import rospy
from rospy.msg import serialize_message

from rbx1_nav.extras.lockstep.processes import find_pollers, polling, still_polling
from rbx1_nav.extras.lockstep.watched_nodes import Watch

NODE_TIMEOUT = 5.0      # s of wall time that the clock waits for a node
LOOK = 2e-5, 5e-3   # s of wall time between two checks of the processes: at least, at most
LONGEST_LOOK = 0.1  # s: if it takes longer from one check to the next, the base itself was suspended
LOOK_LATER = 0.05   # s between two checks per s of waiting so far: a node that is starting needs the processor itself
INTERVALS = 2       # between the first commands of a motion, of which one may be unusual
HOLDS = 3           # ticks with commands at which the clock is held, at the beginning of a motion
HOLD_LATER = 128    # later, the clock is held at each tick whose number is a multiple of this
HOLD = 1.5          # duration of a hold, in intervals between two commands
FIRST_HOLD = 0.02   # s of wall time: duration of the first hold, before an interval is known
COMMANDS = 3        # that a driver on the clock may send after one message; stops do not count
LONG_WAIT = 2.0     # s of wall time: if a wait takes longer, the log says for whom
LONG = 0.1          # s of wall time: if a wait takes longer, threads that poll may be the reason
SLEEP = 0.05        # s: the longest sleep between two checks for a shutdown request


class Received(NamedTuple):
    """A command that has arrived."""

    # Any: a base, whose apply(command) is called later, and a velocity with `linear` (m/s) and `angular` (rad/s)
    target: Any
    header: dict[str, str]      # of the connection; one object for each connection
    command: Any
    time: float                 # s of the monotonic clock
    idle: bool                  # whether it arrived although everything was asleep

    def moves(self) -> bool:
        """Return whether it is not a stop."""
        return bool(self.command.linear or self.command.angular)


class DriverConnection:
    """A connection on which commands arrive, and what is known of its node."""

    def __init__(self, header: dict[str, str]) -> None:
        self.header = header
        self.name = header['callerid']
        self.in_step = True
        self.moving = False     # whether the last command was not a stop
        self.tick = 0           # of the last command
        self.first_tick = 0     # of the first command to move
        self.time = 0.0         # s of the monotonic clock: of the last command
        self.intervals: list[float] = []    # s of wall time between the first commands of the motion
        self.holds = 0          # ticks with commands at which the clock will be held


class Lockstep:
    """Delivers messages, and applies each command at the tick at which it was sent."""

    def __init__(self, watch: Watch, report: Callable[[str, str], None], ended: Callable[[], bool]) -> None:
        """report(name, reason): reports a node that is not in step; ended(): whether to stop waiting."""
        self.watch = watch
        self.report = report
        self.ended = ended
        # by the id of the header, which stays unique because the DriverConnection keeps the header alive
        self.drivers: dict[int, DriverConnection] = {}
        self.lock = Lock()
        self.arrived: list[Received] = []       # commands that settle() has not ordered yet
        self.ready: list[tuple[Any, Any]] = []   # commands in the order in which they take effect
        self.idle = True        # whether everything was asleep, and nothing has been delivered since
        self.held = False       # whether the clock was held after the last tick
        self.tick = 0

    def receive(self, target: Any, header: dict[str, str], command: Any) -> None:
        """Accept a command that just arrived, in any thread. header: see Received."""
        with self.lock:     # a node that is starting may wait by the wall clock, and send through a relay
            self.arrived.append(Received(target, header, command, monotonic(),
                                         self.idle and not self.watch.starting))
        self.watch.starting.pop(header['callerid'], None)

    def begin(self) -> None:
        """Begin a tick. What has woken by itself still belongs to the tick before."""
        self.tick += 1
        moving = {driver.name for driver in self.drivers.values() if driver.moving}
        # otherwise, all drivers have just sent a command, and wait for the tick
        check = self.watch.update() or self.held or not self.watch.drivers or not self.watch.drivers <= moving
        while True:
            if check:
                self._settle()
            with self.lock:     # if nothing has arrived, the next tick has begun
                check = self.idle = bool(self.arrived)
            if not check:
                return

    def deliver(self, publisher: rospy.Publisher, message: Message) -> None:
        """Publish a message, and wait until everything that it has woken is asleep again."""
        topic = publisher.impl
        groups = self.watch.groups(topic)
        if not groups:
            return
        topic.seq += 1
        buffer = BytesIO()
        serialize_message(buffer, topic.seq, message)
        for connections, wait in groups:
            for connection in connections:
                try:
                    connection.write_data(buffer.getvalue())
                except Exception:       # of various kinds, also if another thread closes it
                    connection.close()      # the node has exited
            if wait:
                self._settle(isinstance(message, Clock))

    def apply(self) -> None:
        """Put the commands that have arrived in force."""
        ready, self.ready = self.ready, []
        for target, command in ready:
            target.apply(command)

    def listen(self, until: float) -> None:
        """Wait until a time (s of the monotonic clock), or longer if this tick tests who sends without being woken."""
        self.idle = True
        hold = max(map(self._hold, self.drivers.values()), default=0.0)
        self.held = hold > 0
        later = max(until, monotonic() + hold)
        for driver in self.drivers.values():
            driver.time += min(hold, later - until)     # not part of the interval
        processes = self.watch.processes.values()
        if any(process.new_threads for process in processes):
            find_pollers(processes)
        while monotonic() < later and not self.ended():
            sleep(max(0.0, min(later - monotonic(), SLEEP)))

    def _hold(self, driver: DriverConnection) -> float:
        """Return for how long to hold the clock after this tick because of a driver, s of wall time."""
        if not (driver.moving and driver.name in self.watch.drivers):
            return 0.0
        if driver.holds:
            if driver.tick != self.tick:
                return 0.0
            driver.holds -= 1
            return FIRST_HOLD if driver.first_tick == self.tick else HOLD * max(driver.intervals, default=0.0)
        return HOLD * min(driver.intervals) if self.tick % HOLD_LATER == 0 else 0.0

    def _settle(self, new_time: bool = False) -> None:
        """Wait until everything is asleep, and order the commands that have arrived. new_time: whether the time was
        delivered, for which some threads poll."""
        self._wait_while_awake()
        threads = new_time and polling(self.watch.processes.values())     # these may not have seen the time yet
        if threads:
            while still_polling(threads) and not self.ended():
                sleep(LOOK[0])
            self._wait_while_awake()
        with self.lock:
            arrived, self.arrived = self.arrived, []
        # the order must not depend on chance
        arrived.sort(key=lambda each: each.header['callerid'])
        counts = Counter(id(each.header) for each in arrived if each.moves())
        for each in arrived:
            self._check(each, counts[id(each.header)])
            self.ready.append((each.target, each.command))

    def _wait_while_awake(self) -> None:
        begin = last = monotonic()
        awake: dict[str, float] = {}    # s of wall time for which each node was awake
        said = False
        while not self.ended():
            name = self.watch.waits_for()
            if not name:
                return
            now = monotonic()
            awake[name] = awake.get(name, 0.0) + min(now - last, LONGEST_LOOK)
            last = now
            if awake[name] > NODE_TIMEOUT:
                if name == self.watch.own_name:     # messages keep this node busy: no reason to blame anybody
                    return
                del awake[name]
                if self.watch.forget(name):
                    self.report(name, f'did not become idle within {NODE_TIMEOUT:g} s')
            if now - begin > LONG_WAIT and name != self.watch.own_name and not said:
                said = True
                rospy.loginfo('The clock waits for %s', name)
            if now - begin > LONG:
                # again: on a busy machine, such a thread may not run for a while
                find_pollers(self.watch.processes.values())
            sleep(min(max(LOOK[0], LOOK_LATER * (now - begin)), LOOK[1]))

    def _check(self, received: Received, count: int) -> None:
        """Update what is known of a driver with a command, and report it if the command is not in step. count: of the
        moving commands that have arrived together."""
        header = received.header
        if id(header) not in self.drivers:
            self.drivers = {key: driver for key, driver in self.drivers.items()
                            if self.watch.is_connected(driver.header)}
            self.drivers[id(header)] = DriverConnection(header)
        driver = self.drivers[id(header)]
        first = not driver.moving
        driver.moving = received.moves()
        if not driver.moving:
            return
        if first:
            driver.first_tick = driver.first_tick or self.tick
            driver.intervals, driver.holds = [], HOLDS
        elif len(driver.intervals) < INTERVALS:
            driver.intervals.append(received.time - driver.time)
        driver.tick, driver.time = self.tick, received.time
        driver.in_step = driver.in_step and driver.name not in self.watch.forgotten     # reported already
        if not driver.in_step:
            return
        later = driver.first_tick != self.tick      # a node may wait by the wall clock before its first motion
        reason = None
        if later and self.watch.is_connected(driver.header):    # not if it has exited, and is no longer visible
            reason = self.watch.obstacle(driver.name)
        if not reason and count > COMMANDS:
            reason = f'sends more than {COMMANDS} commands at once'
        elif not reason and later and received.idle and not self.watch.find_sources():
            reason = 'sends commands that no tick of /clock has prompted'
        if reason:
            self.watch.forget(driver.name)
            for each in self.drivers.values():      # a node may have several publishers
                each.in_step = each.in_step and each.name != driver.name
            self.report(driver.name, reason)
