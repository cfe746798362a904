"""Waits for the subscribers of a topic: what is published before they are connected is lost."""
import threading
import time

import rosgraph
import rospy

from rbx1_nav.ros.master import call
from rbx1_nav.ros.node import end_requested, sleep


class _SubscriberMonitor(threading.Thread):
    """Keeps the list of live subscribers of a topic up to date, until it is stopped."""

    def __init__(self, topic):
        super().__init__(daemon=True)
        self.topic = topic
        self.live = None        # names of the live subscribers; None until the master has answered
        self.dead = set()
        self.done = threading.Event()

    def run(self):
        master = rosgraph.get_master_uri()
        while not self.done.is_set():
            try:
                _, subscribers, _ = call(master, 'getSystemState')
                names = {name for topic, nodes in subscribers if topic == self.topic for name in nodes}
                self.live = {name for name in names if self.is_alive_node(master, name)}
            except Exception as error:      # pylint: disable=broad-except
                rospy.logwarn_throttle(5, 'The master at %s does not answer: %s' % (master, error))
            self.done.wait(0.1)

    def is_alive_node(self, master, name):
        """Whether a node answers; one that did not is not called again."""
        if name not in self.dead:
            try:
                call(call(master, 'lookupNode', name), 'getPid')
                return True
            except Exception:       # pylint: disable=broad-except
                self.dead.add(name)
                rospy.logwarn('%s is registered as a subscriber of %s but does not answer: ignored '
                              '(`rosnode cleanup` removes it)', name, self.topic)
        return False


def connected_nodes(publisher):
    """Names of the nodes that are connected to a publisher now."""
    return {connection.endpoint_id for connection in publisher.impl.connections}


def wait_for_subscribers(publisher, timeout):
    """Wait until all live subscribers of a publisher's topic are connected to it, and simulated time has begun.

    All of them and not just the first: a recorder is not a base. Raises ROSException if there is none, or one is
    missing, after `timeout` seconds of wall time, and ROSInterruptException as soon as the node is to end.
    """
    topic = publisher.resolved_name
    monitor = _SubscriberMonitor(topic)
    monitor.start()
    deadline = time.monotonic() + timeout
    log_time = time.monotonic() + 0.5
    try:
        while True:
            connected = connected_nodes(publisher)
            if connected and monitor.live is not None and monitor.live <= connected and rospy.get_rostime():
                return
            missing = ', '.join(sorted((monitor.live or set()) - connected))
            what = ('the master to list the subscribers of %s' % topic if monitor.live is None
                    else '%s to connect to %s' % (missing, topic) if missing
                    else 'a base that subscribes to %s' % topic if not connected else 'the time on /clock')
            if time.monotonic() > deadline:
                raise rospy.ROSException('Timed out after %g s waiting for %s' % (timeout, what))
            if time.monotonic() > log_time:
                log_time += 5
                rospy.loginfo('Waiting for %s', what)
            sleep(0.02)
            if end_requested.is_set():
                raise rospy.ROSInterruptException('shutdown requested')
    finally:
        monitor.done.set()
