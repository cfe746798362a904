"""Keeps a simulated clock in step with the nodes that use it to drive.

A tick is over when everything that it woke is asleep again: every driver has sent its commands for this tick, and the
commands have arrived. Only then does the next tick begin. So a run has the same result on every machine and at every
speed, whatever the rates of the drivers are. For this, the processes of the drivers, the `nodes`, are observed. Where
that is not possible, answers.py counts commands instead.
"""
from __future__ import annotations

from collections import deque
from functools import partial
from threading import Condition
from time import monotonic, sleep
from typing import Any, Callable, Deque, Protocol

from rbx1_nav.simulation.answers import BURST_TIME, Answers, NotInStep, ReceivedCommand
from rbx1_nav.simulation.stream import Stream

NODE_TIMEOUT = 5.0      # s of wall time that a tick waits for a node
LOOK = 2e-5, 5e-3   # s of wall time between two checks of the nodes: at least, at most
LOOK_LATER = 0.05   # s between two checks per s of waiting so far: a node that is starting needs the processor itself
# a driver is released after this number of commands that no tick has prompted: one may be the stop after Ctrl-C
UNPROMPTED = 3
STEADY = 25         # ticks: a driver that has sent one command at each of them will also do so at the next tick
ANSWER_TIME = 0.005     # s of wall time to wait for this command before the nodes are checked


class Nodes(Protocol):
    """Observes the processes of nodes; implemented in ros/base/driving_nodes.py."""

    drivers: set[str]

    def update(self) -> None: ...
    def sees(self, name: str) -> bool: ...
    def on_clock(self, name: str) -> bool: ...
    def note(self, names: set[str]) -> None: ...
    def mark(self, names: set[str]) -> None: ...
    def woke_by_itself(self, name: str) -> bool: ...
    def connecting(self) -> bool: ...
    def awake(self) -> str | None: ...
    def awake_drivers(self) -> str | None: ...
    # Any: the result of polling() is only passed to still_polling()
    def polling(self) -> list[Any]: ...
    def still_polling(self, threads: list[Any]) -> bool: ...
    def forget(self, name: str) -> None: ...
    def update_upstream(self) -> bool: ...
    def connected(self, header: object) -> bool: ...
    def unread(self, header: object) -> bool: ...


class CommandSource:
    """A connection on which commands arrive."""

    def __init__(self, connection: object, name: str) -> None:
        self.connection = connection
        self.name = name
        self.seen: bool | None = None           # whether its process can be observed; None: not known yet
        self.answers: Answers | None = None     # an Answers if the process cannot be observed
        self.stream: Stream | None = None       # a Stream, from its first motion to its next stop
        self.released = False       # whether it is not in step: its commands take effect as they arrive

    def steady(self, tick: int) -> bool:
        """Return whether it has sent one command at each of the ticks before this one, and so will send one now."""
        return self.stream is not None and self.stream.in_a_row >= STEADY and self.stream.last == tick - 1


class Lockstep:
    """Applies each command at the tick at which it was sent.

    A command is a tuple that begins with linear (m/s) and angular (rad/s).
    """

    def __init__(self, apply: Callable[[ReceivedCommand], None], report: Callable[[str, str], None], nodes: Nodes,
                 ended: Callable[[], bool]) -> None:
        """apply(command): puts a command in force; report(name, reason): reports a node that is not in step; ended():
        whether to stop waiting."""
        self.apply = apply
        self.report = report
        self.nodes = nodes
        self.ended = ended
        # by the id of the connection, which stays unique because the CommandSource keeps the connection alive
        self.drivers: dict[int, CommandSource] = {}
        # (driver, command, whether a tick may have prompted it), not in force yet
        self.arrived: list[tuple[CommandSource, ReceivedCommand, bool]] = []
        self.delayed: list[ReceivedCommand] = []    # commands for the next tick
        self.tick = 0           # number of the current tick
        self.ticks: Deque[float] = deque()      # s of the monotonic clock: the ticks of the last BURST_TIME
        self.over = True        # whether the current tick is over
        self.changed = Condition()

    def receive(self, connection: object, name: str, command: ReceivedCommand) -> None:
        """Accept a command that just arrived, in any thread.

        connection: any object; name: name of the node that sent the command.
        """
        with self.changed:
            driver = self.drivers.get(id(connection))
            if not driver:
                self.drivers = {key: each for key, each in self.drivers.items()
                                if (each.answers and each.answers.queue) or self.nodes.connected(each.connection)}
                driver = self.drivers[id(connection)] = CommandSource(connection, name)
            if driver.released:
                self.apply(command)
            elif driver.answers:
                driver.answers.receive(command)
            else:
                self.arrived.append((driver, command, not self.over))
            self.changed.notify()

    def begin_tick(self) -> None:
        """Begin a tick; call this before each tick.

        A node that has woken by itself still belongs to the previous tick.
        """
        quiet = self.nodes.drivers - {driver.name for driver in self._seen_drivers() if driver.stream}
        if quiet or self.nodes.connecting():
            self._settle(quiet)
        while not self._begin():
            self._settle(quiet)
            self._apply_arrived()

    def _settle(self, quiet: set[str]) -> None:
        """Wait until everything is asleep. A quiet node that runs during this check may still be sending a command."""
        self.nodes.note(quiet)
        self._wait_until_asleep()
        self.nodes.mark(quiet)

    def end_tick(self) -> None:
        """Wait for the outstanding commands, and put them in force; call this after each tick."""
        delayed, self.delayed = self.delayed, []
        for command in delayed:
            self.apply(command)
        if self._all_steady_have_sent():
            self._wait_while_awake(self.nodes.awake_drivers)
        else:
            self._wait_until_asleep()
        self._apply_arrived()
        for driver in list(self.drivers.values()):
            if driver.answers:
                self._collect(driver, driver.answers)

    def _begin(self) -> bool:
        """Begin the next tick unless there are commands of the current one; return whether it has begun."""
        with self.changed:
            if self.arrived:
                return False
            self.over = False
            self.tick += 1
            now = monotonic()
            self.ticks.append(now)
            while self.ticks[0] < now - BURST_TIME:
                self.ticks.popleft()
            return True

    def _seen_drivers(self) -> list[CommandSource]:
        """Return the drivers that are in step and whose processes are observed."""
        return [driver for driver in list(self.drivers.values())
                if driver.seen and not driver.released and driver.name in self.nodes.drivers]

    def _wait_until_asleep(self) -> None:
        """Wait until everything that a tick or another event woke is asleep again."""
        self._wait_while_awake(self.nodes.awake)
        polling = self.nodes.polling()      # these may not have seen the tick yet
        if polling:
            while self.nodes.still_polling(polling) and not self.ended():
                sleep(LOOK[0])
            self._wait_while_awake(self.nodes.awake)

    def _wait_while_awake(self, look: Callable[[], str | None]) -> None:
        """Wait while a node is awake. look(): returns the name of a node that is awake, or None."""
        begin = monotonic()
        deadline = begin + NODE_TIMEOUT
        while not self.ended():
            name = look()
            if not name:
                return
            now = monotonic()
            if now > deadline:
                self._give_up(name)
                deadline += NODE_TIMEOUT
            sleep(min(max(LOOK[0], LOOK_LATER * (now - begin)), LOOK[1]))

    def _all_steady_have_sent(self) -> bool:
        """Return whether all nodes that may drive are steady and have sent their commands.

        In this case no other node needs to be checked.
        """
        self.nodes.update()     # a node that has connected in the meantime must be checked
        drivers = self._seen_drivers()
        if not drivers or len(drivers) < len(self.nodes.drivers):
            return False
        if not all(driver.steady(self.tick) for driver in drivers):
            return False
        with self.changed:
            return self.changed.wait_for(
                lambda: self.ended() or {id(each[0]) for each in self.arrived} >= set(map(id, drivers)), ANSWER_TIME)

    def _give_up(self, name: str) -> None:
        """Stop waiting for a node, which need not be a driver."""
        for driver in self._seen_drivers():
            driver.released = driver.released or driver.name == name
        self.nodes.forget(name)
        self.report(name, f'did not become idle within {NODE_TIMEOUT:g} s')

    def _new_drivers(self) -> list[CommandSource]:
        with self.changed:
            return [driver for driver, _, _ in self.arrived if driver.seen is None]

    def _apply_arrived(self) -> None:
        new = self._new_drivers()
        while new:
            for driver in new:      # without the lock, so that commands can still be received
                driver.seen = self.nodes.sees(driver.name)
            new = self._new_drivers()       # another driver may have sent its first command by now
        with self.changed:
            # the order within a tick must not depend on chance
            arrived = sorted((each for each in self.arrived if each[0].seen is not None), key=lambda each: each[0].name)
            self.arrived = [each for each in self.arrived if each[0].seen is None]
            self.over = True
            for driver, command, prompted in arrived:
                if not (driver.seen or driver.answers):
                    driver.answers = Answers(self.ticks, self.changed, partial(self.nodes.connected, driver.connection),
                                             partial(self.nodes.unread, driver.connection), self.ended)
                if driver.answers:
                    driver.answers.receive(command)
                else:
                    self._apply(driver, command, prompted)

    def _apply(self, driver: CommandSource, command: ReceivedCommand, prompted: bool) -> None:
        """Put a command in force, now or at the next tick."""
        linear, angular, *_ = command
        velocity, lag = (linear, angular), 0
        if driver.stream:
            if not driver.released:
                self._check_prompt(driver, driver.stream, prompted)
            lag = driver.stream.lag_of(self.tick, velocity)
        elif any(velocity):
            driver.stream = Stream(self.tick, velocity, prompted and self.nodes.woke_by_itself(driver.name))
        if not any(velocity):
            driver.stream = None
        if lag and not driver.released:
            self.delayed.append(command)
        else:
            self.apply(command)

    def _check_prompt(self, driver: CommandSource, stream: Stream, prompted: bool) -> None:
        """Release a driver whose commands are not prompted by ticks."""
        if not self.nodes.on_clock(driver.name):
            self._release(driver, 'does not subscribe to /clock')
        elif not prompted:
            stream.unprompted += 1
            if stream.unprompted >= UNPROMPTED and not self.nodes.update_upstream():
                self._release(driver, 'sends commands that no tick of /clock has prompted')

    def _release(self, driver: CommandSource, reason: str) -> None:
        driver.released = True
        self.nodes.forget(driver.name)
        self.report(driver.name, reason)

    def _collect(self, driver: CommandSource, answers: Answers) -> None:
        with self.changed:
            try:
                command = answers.next()
            except NotInStep as error:
                self._release(driver, str(error))
                command = answers.queue[-1] if answers.queue else None
                driver.answers = None
            if command:
                self.apply(command)
