"""Driving by hand: while keys are held in a browser, commands are published at a constant rate.

A browser that crashes cannot report a released key, so keys that are not repeated count as released.
"""
from __future__ import annotations

from contextlib import suppress
from threading import Condition, Thread
import time
from typing import Callable

from geometry_msgs.msg import Twist, Vector3
import rospy

COMMANDS = 'cmd_vel'     # rospy.resolve_name() applies the namespace and a remapping
KEY_TIMEOUT = 0.3   # s after the last message of the driving browser; the robot must stop within 0.5 s
PERIOD = 0.05       # s between commands
LINGER = 1.0        # s during which zero commands are sent after the last command, and after Stop


def command_publisher(namespace: str = '') -> Callable[[float, float], None]:
    """Return a function that publishes a command (m/s, rad/s). The publisher stays registered, because a subscriber of
    rospy that connects while a publisher unregisters may keep a dead connection to it.

    namespace: of the robot, with a slash at the end, '' for the namespace of this node.
    """
    publisher = rospy.Publisher(f'{namespace}{COMMANDS}', Twist, queue_size=5, tcp_nodelay=True)

    def publish(linear: float, angular: float) -> None:
        with suppress(rospy.ROSException):  # closed by the shutdown of the node, which sends its own stop
            publisher.publish(Vector3(x=linear), Vector3(z=angular))
    return publish


class Keys:
    """The held keys of the driving browser; only one browser can drive at a time."""

    def __init__(self) -> None:
        self.owner: object = None
        self.speed = 0.0, 0.0   # m/s, rad/s
        self.time = 0.0         # s, monotonic clock: last message of the owner

    def hold(self, owner: object, linear: float, angular: float, now: float) -> bool:
        """Set the velocity of the held keys; 0, 0 releases them. Returns False if another browser is driving."""
        if self.owner is not None and owner is not self.owner and now - self.time < KEY_TIMEOUT:
            return False
        self.owner = owner if linear or angular else None
        self.speed, self.time = (linear, angular), now
        return True

    def release(self) -> None:
        self.owner, self.speed = None, (0.0, 0.0)

    def velocity(self, now: float) -> tuple[float, float]:
        """Return the commanded velocity at the time `now`, m/s and rad/s; zero if the keys have timed out."""
        if now - self.time > KEY_TIMEOUT:
            self.release()
        return self.speed


class HandDrive:
    """Sends the commands in a separate thread, so that nothing else in the server can delay a stop."""

    def __init__(self, publish: Callable[[float, float], None], clock: Callable[[], float] = time.monotonic) -> None:
        """publish(linear, angular): sends a command, m/s and rad/s; clock(): returns the monotonic time, s."""
        self.publish = publish
        self.clock = clock
        self.keys = Keys()
        self.drivers: set[object] = set()   # the browsers in which driving by hand is on
        self.stop_until = 0.0       # s: zero commands are sent until then
        self.changed = Condition()
        self.ended = False
        self.thread = Thread(target=self._run, daemon=True)

    def start(self) -> None:
        """Start the thread."""
        self.thread.start()

    def begin(self, owner: object) -> None:
        """Switch driving by hand on for a browser."""
        with self.changed:
            self.drivers.add(owner)

    def leave(self, owner: object) -> None:
        """Switch driving by hand off for a browser, or remove a browser that has disconnected."""
        with self.changed:
            if owner is self.keys.owner:
                self._stop()
            self.drivers.discard(owner)
            self.changed.notify_all()

    def drive(self, owner: object, linear: float, angular: float) -> bool:
        """Drive at this velocity, m/s and rad/s. Returns False if driving by hand is off, or another browser drives."""
        with self.changed:
            if owner not in self.drivers or not self.keys.hold(owner, linear, angular, self.clock()):
                return False
            if not (linear or angular):
                self._stop()
            self.changed.notify_all()
            return True

    def stop(self) -> None:
        """Stop the robot, and switch driving by hand off for all browsers."""
        with self.changed:
            self.drivers.clear()
            self._stop()
            self.changed.notify_all()

    def wait_until_quiet(self, cancelled: Callable[[], bool]) -> None:
        """Wait until the zero commands after driving by hand have been sent, or until cancelled(). A Stop meanwhile
        does not make the wait longer."""
        with self.changed:
            quiet = self.stop_until
            while self.clock() < quiet and not (self.ended or cancelled()):
                self.changed.wait(PERIOD)

    def _stop(self) -> None:
        self.keys.release()
        self.stop_until = self.clock() + LINGER

    def end(self) -> None:
        """Stop the robot if it is being driven by hand, and stop the thread."""
        with self.changed:
            self.ended = True
            self.keys.release()
            self.changed.notify_all()
        self.thread.join(0.5)

    def _run(self) -> None:
        moving = stopping = False
        while True:
            with self.changed:
                if self.ended:
                    break
                now = self.clock()
                velocity = self.keys.velocity(now)
                if moving and not any(velocity):    # including keys that have timed out
                    self.stop_until = now + LINGER
                stopping, moving = now < self.stop_until, any(velocity)
                if not (moving or stopping):
                    self.changed.wait()
                    continue
            self.publish(*velocity)
            with self.changed:
                if not self.ended:
                    self.changed.wait(PERIOD)
        if moving or stopping:
            self.publish(0.0, 0.0)
