"""Driving by hand: the keys that one browser holds become a steady stream of commands, until they are released.

A browser that goes away releases nothing, so a key counts as released if it is not repeated.
"""
from __future__ import annotations

from threading import Condition, Thread
import time
from typing import Callable, Protocol

KEY_TIMEOUT = 0.3   # s without a message of the browser that drives; the robot has to stop within 0.5 s
PERIOD = 0.05       # s from command to command
LINGER = 1.0        # s for which zeros are sent after the last command, and after Stop


class Publisher(Protocol):
    """What sends commands to the base."""

    def open(self) -> None:
        """Commands will follow; without effect if it is open."""

    def publish(self, linear: float, angular: float) -> None:
        """Send a command, m/s and rad/s."""

    def close(self) -> None:
        """No command follows for now: other nodes may drive."""


class Keys:
    """The keys that are held, of one browser at a time."""

    def __init__(self) -> None:
        self.owner: object = None
        self.speed = 0.0, 0.0   # m/s, rad/s
        self.time = 0.0         # s of a monotonic clock: when the owner repeated them

    def hold(self, owner: object, linear: float, angular: float, now: float) -> bool:
        """A browser holds keys for this velocity; 0, 0 releases them. Returns False if another one drives now."""
        if self.owner is not None and owner is not self.owner and now - self.time < KEY_TIMEOUT:
            return False
        self.owner = owner if linear or angular else None
        self.speed, self.time = (linear, angular), now
        return True

    def release(self) -> None:
        """No key is held any more."""
        self.owner, self.speed = None, (0.0, 0.0)

    def velocity(self, now: float) -> tuple[float, float]:
        """The velocity for now, m/s and rad/s."""
        if now - self.time > KEY_TIMEOUT:
            self.release()
        return self.speed


class HandDrive:
    """Sends the commands, in a thread of its own: nothing else of the server may delay a stop."""

    def __init__(self, publisher: Publisher, clock: Callable[[], float] = time.monotonic) -> None:
        """clock(): s."""
        self.publisher = publisher
        self.clock = clock
        self.keys = Keys()
        self.drivers: set[object] = set()   # the browsers that drive by hand
        self.stop_until = 0.0       # s: zeros are sent until then
        self.changed = Condition()
        self.ended = False
        self.thread = Thread(target=self._run, daemon=True)

    def start(self) -> None:
        """Begin."""
        self.thread.start()

    def begin(self, owner: object) -> None:
        """A browser is going to drive by hand: the connection to the base is made now, for the first key to count."""
        with self.changed:
            self.drivers.add(owner)
            self.changed.notify()

    def leave(self, owner: object) -> None:
        """A browser no longer drives by hand, or has gone."""
        with self.changed:
            if owner is self.keys.owner:
                self._stop()
            self.drivers.discard(owner)
            self.changed.notify()

    def drive(self, owner: object, linear: float, angular: float) -> bool:
        """A browser holds keys, m/s and rad/s. Returns False if it may not drive, or another one drives now."""
        with self.changed:
            if owner not in self.drivers or not self.keys.hold(owner, linear, angular, self.clock()):
                return False
            if not (linear or angular):
                self._stop()
            self.changed.notify()
            return True

    def stop(self) -> None:
        """Send zeros, whoever drives by hand; each browser has to begin again."""
        with self.changed:
            self.drivers.clear()
            self._stop()
            self.changed.notify()

    def _stop(self) -> None:
        self.keys.release()
        self.stop_until = self.clock() + LINGER

    def end(self) -> None:
        """Stop the robot, if it was driven by hand, and end the thread."""
        with self.changed:
            self.ended = True
            self.keys.release()
            self.changed.notify()
        self.thread.join(0.5)

    def _run(self) -> None:
        opened = moving = stopping = False
        while True:
            with self.changed:
                if self.ended:
                    break
                now = self.clock()
                velocity = self.keys.velocity(now)
                if moving and not any(velocity):    # also if the keys have timed out
                    self.stop_until = now + LINGER
                stopping = now < self.stop_until
                wanted = bool(self.drivers) or stopping
                if not (wanted or opened):
                    self.changed.wait()
                    continue
            if wanted:
                self.publisher.open()
            else:
                self.publisher.close()
            if any(velocity) or stopping:
                self.publisher.publish(*velocity)
            opened, moving = wanted, any(velocity)
            with self.changed:
                if not self.ended:
                    self.changed.wait(PERIOD)
        if moving or stopping:
            self.publisher.publish(0.0, 0.0)
