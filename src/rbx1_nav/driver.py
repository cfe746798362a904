"""What a script that drives a robot should not have to think about: when to start, and how to keep time.

A driving script publishes from its main thread only. A request to end the node reaches it as an exception from its next
sleep() or pause(), and it stops the robot itself.
"""
import threading
import time
from xmlrpc.client import ServerProxy, Transport

import rosgraph
import rospy

from rbx1_nav.config import ConfigError, Section, positive
from rbx1_nav.node import end_requested, sleep

ANSWER_TIMEOUT = 2.0    # s of wall time in which a live node, or the master, answers a call


def positive_param(name, default):
    """The private parameter `name`: a finite number above 0. Raises ROSException, in one line, if it is not."""
    try:
        return positive(name, rospy.get_param('~' + name, default))
    except ConfigError as error:
        raise rospy.ROSException('%s/%s' % (rospy.get_name(), error))


def frame_param(name, default):
    """The private parameter `name`: a frame, without a leading slash. Raises ROSException, in one line, if it is not.

    default: may be None too.
    """
    if not rospy.has_param('~' + name):
        return default
    try:
        return Section({name: rospy.get_param('~' + name)}, '').frame(name, '')
    except ConfigError as error:
        raise rospy.ROSException('%s/%s' % (rospy.get_name(), error))


# Keeping time

def _now():
    """ns of simulated time, or of a wall clock that nobody can set."""
    return time.monotonic_ns() if rospy.rostime.is_wallclock() else rospy.get_rostime().to_nsec()


def _wait_until(end, longest, publisher):
    """Wait until _now() is `end` (ns), but not longer than `longest` (ns) on a clock that jumped back.

    Raises ROSException when nobody listens to the publisher any more: a clock that stands may have gone with them.
    """
    warn_time = time.monotonic() + 5
    last = None
    while True:
        if end_requested.is_set():
            raise rospy.ROSInterruptException('asked to end')
        if not connections(publisher):
            raise rospy.ROSException('Nobody listens on %s any more' % publisher.resolved_name)
        now = _now()
        end = min(end, now + longest)
        if now >= end:
            return
        if rospy.rostime.is_wallclock():
            sleep((end - now) / 1e9)
            continue
        clock_moved = rospy.rostime.get_rostime_cond()
        with clock_moved:
            if _now() == now:
                clock_moved.wait(0.05)
        if now != last:
            last, warn_time = now, time.monotonic() + 5
        elif time.monotonic() > warn_time:
            warn_time += 5
            rospy.logwarn('/use_sim_time is true, but the time on /clock stands still')


def pause(seconds, publisher):
    """Wait for so many seconds of ROS time. Raises ROSInterruptException as soon as the node is to end, and ROSException
    when nobody listens to the publisher any more."""
    duration = round(seconds * 1e9)
    _wait_until(_now() + duration, duration, publisher)


class Rate:
    """rospy.Rate for commands: ends at once when the node is to end, and never sends two ticks at once.

    A tick that came late is made up for over the next ones, each at least 0.6 periods long: a base that is driven by
    time would otherwise see two commands in one step.
    """

    def __init__(self, hz, publisher):
        """hz: ticks per second of ROS time, the first one a period from now; publisher: of the commands."""
        self.publisher = publisher
        self.period = round(1e9 / hz)
        self.next = _now() + self.period

    def sleep(self):
        """Wait for the next tick. Raises ROSInterruptException as soon as the node is to end, and ROSException when nobody
        listens to the publisher any more."""
        _wait_until(self.next, self.period, self.publisher)
        now = _now()
        self.next = min(max(self.next + self.period, now + self.period * 6 // 10), now + self.period)


# Knowing who listens

class _ImpatientTransport(Transport):
    """XML-RPC that does not wait for ever."""

    def make_connection(self, host):
        connection = super().make_connection(host)
        connection.timeout = ANSWER_TIMEOUT
        return connection


def _call(uri, method, *args):
    """The value of a call to the master or a node. Raises OSError or xmlrpc.client.Error if there is none."""
    with ServerProxy(uri, transport=_ImpatientTransport()) as server:
        return getattr(server, method)(rospy.get_name(), *args)[2]


class _Census(threading.Thread):
    """Asks the master who subscribes to a topic, and those whether they are alive, until it is stopped."""

    def __init__(self, topic):
        super().__init__(daemon=True)
        self.topic = topic
        self.listeners = None   # names of the live subscribers; None before the master answered
        self.dead = set()
        self.done = threading.Event()

    def run(self):
        master = rosgraph.get_master_uri()
        while not self.done.is_set():
            try:
                _, subscribers, _ = _call(master, 'getSystemState')
                names = {name for topic, nodes in subscribers if topic == self.topic for name in nodes}
                self.listeners = {name for name in names if self.alive(master, name)}
            except Exception as error:      # pylint: disable=broad-except
                rospy.logwarn_throttle(5, 'The master at %s does not answer: %s' % (master, error))
            self.done.wait(0.1)

    def alive(self, master, name):
        """Whether a node answers; one that did not is not asked again."""
        if name not in self.dead:
            try:
                _call(_call(master, 'lookupNode', name), 'getPid')
                return True
            except Exception:       # pylint: disable=broad-except
                self.dead.add(name)
                rospy.logwarn('%s is registered as a subscriber of %s but does not answer: skipped', name, self.topic)
        return False


def connections(publisher):
    """Names of the nodes that are connected to a publisher now."""
    return {connection.endpoint_id for connection in publisher.impl.connections}


def wait_for_subscribers(publisher, timeout):
    """Wait until all live subscribers that the master lists for a publisher's topic are connected to it.

    Not just the first one: a recorder that happens to listen is not the base. Raises ROSException if there is none, or
    one is missing, after `timeout` seconds of wall time.
    """
    topic = publisher.resolved_name
    census = _Census(topic)
    census.start()
    give_up = time.monotonic() + timeout
    say_time = time.monotonic() + 0.5
    try:
        while True:
            connected = connections(publisher)
            if connected and census.listeners is not None and census.listeners <= connected and _now() > 0:
                return
            missing = ', '.join(sorted((census.listeners or set()) - connected))
            what = ('an answer from who is to listen on %s' % topic if census.listeners is None
                    else '%s to connect to %s' % (missing, topic) if missing
                    else 'a base to listen on %s' % topic if not connected else 'the time on /clock')
            if time.monotonic() > give_up:
                raise rospy.ROSException('Waited %g s in vain for %s' % (timeout, what))
            if time.monotonic() > say_time:
                say_time += 5
                rospy.loginfo('Waiting for %s', what)
            sleep(0.02)
            if end_requested.is_set():
                raise rospy.ROSInterruptException('asked to end')
    finally:
        census.done.set()
