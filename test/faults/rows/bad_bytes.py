"""Connections that do not speak ROS, to the ports of the nodes: the nodes keep running, and the run finishes."""
import contextlib
import os
import socket
import struct
import time
from urllib.parse import urlparse
from xmlrpc.client import ServerProxy

from geometry_msgs.msg import PoseWithCovarianceStamped
import rospy

import support

FAULT = 'random, truncated and silent connections to the TCPROS and XML-RPC ports of base, script and filter'
PROMISE = ('the nodes keep running, the run finishes where it should, no thread or file descriptor leaks, new peers '
           'can connect')
FULL, SHORT = 600, 60
ROOT = ALONE = False

FACTOR = 5
SCRIPTS = ('timed_out_and_back.py', 'odom_out_and_back.py')
PER_RUN = 60        # connections in one run
TOPICS = {'/arbotix': '/odom', '/out_and_back': '/cmd_vel', '/robot_pose_ekf': '/odom_combined'}
SILENT = 5          # at once, to one port
POST = b'POST /RPC2 HTTP/1.1\r\nHost: x\r\nContent-Type: text/xml\r\nContent-Length: %d\r\n\r\n%s'
CALL = b'<?xml version="1.0"?><methodCall><methodName>%s</methodName><params>%s</params></methodCall>'


def run(row):
    """See FAULT."""
    row.roscore()
    base = row.base('real_time_factor:=%d' % FACTOR)
    ekf = row.start('roslaunch', '--wait', 'rbx1_nav', 'odom_ekf.launch')
    support.init_node('faults')
    odom = support.OdomWatch()
    estimates = support.Watch('/odom_combined', PoseWithCovarianceStamped)
    estimates.next()
    for count in range(0, row.times, PER_RUN):
        script = SCRIPTS[count // PER_RUN % 2]
        with row.fault(script):
            row.reset()
            driver = row.node(script)
            odom.wait_for_twist(0.2)
            nodes = {name: Node(name, topic) for name, topic in TOPICS.items()}
            for _ in range(min(PER_RUN, row.times - count) - 3 * SILENT):
                row.faults += 1
                bad_bytes(row.random, row.random.choice(list(nodes.values())))
                time.sleep(row.random.uniform(0, 0.08))     # over most of the run
            for node in nodes.values():
                row.faults += SILENT
                silence(node.random_ports(row.random, SILENT))
            for node in nodes.values():
                support.wait_for(node.has_closed_all, node.leak)
            row.check_home(driver, odom)
            estimates.next()
            for process in (base, ekf):
                assert process.process.poll() is None, process.output
            new_peers()


class Node:
    """A node, and what it holds before the connections."""

    def __init__(self, name, topic):
        """topic: one that it publishes."""
        uri = rospy.get_master().lookupNode(name)[2]
        self.name = name
        with ServerProxy(uri) as server:
            self.pid = server.getPid('/faults')[2]
            _, host, port = server.requestTopic('/faults', topic, [['TCPROS']])[2]
        self.tcpros, self.xmlrpc = (host, port), (urlparse(uri).hostname, urlparse(uri).port)
        self.before = self.held()

    def held(self):
        """Its number of threads and of file descriptors."""
        return tuple(len(os.listdir('/proc/%d/%s' % (self.pid, kind))) for kind in ('task', 'fd'))

    def has_closed_all(self):
        """Whether it holds no more than before."""
        return all(now <= before for now, before in zip(self.held(), self.before))

    @property
    def leak(self):
        """What a node that does not close its connections holds."""
        return f'{self.name} to close its connections: {self.held()} threads and file descriptors, {self.before} before'

    def random_ports(self, random, count):
        """So many of its ports."""
        return [random.choice((self.tcpros, self.xmlrpc)) for _ in range(count)]


def bad_bytes(random, node):
    """One connection that sends what is no ROS, reads a little of the answer or none, and closes."""
    noise = bytes(random.randrange(256) for _ in range(random.choice((1, 3, 4, 100, 5000))))
    header = b''.join(struct.pack('<I', len(field)) + field for field in (
        b'callerid=/stranger', b'topic=' + TOPICS[node.name].encode(), b'md5sum=0', b'type=std_msgs/Empty'))
    tcpros = (noise, struct.pack('<I', 2 ** 32 - 1) + noise, struct.pack('<I', 10000) + noise, struct.pack('<I', 0),
              struct.pack('<I', len(header)) + header,
              struct.pack('<I', len(header)) + header[:-random.randrange(1, len(header))],
              struct.pack('<I', len(noise)) + noise, b'GET / HTTP/1.1\r\n\r\n')
    call = CALL % (random.choice((b'getPid', b'noMethod', b'__init__', b'requestTopic', b'publisherUpdate')),
                   random.choice((b'', b'<param><value><int>9e99</int></value></param>', b'<param>' * 2000)))
    xmlrpc = (noise, b'POST / HTTP/9.9\r\n\r\n', POST % (len(call), call), POST % (10 ** 9, call), POST % (-1, call),
              POST % (len(call), call[:-random.randrange(1, len(call))]), POST % (len(noise), noise),
              b'GET /' + b'x' * 70000)
    port = random.choice((node.tcpros, node.xmlrpc))
    with contextlib.suppress(OSError), socket.create_connection(port, 5) as sock:
        sock.sendall(random.choice(tcpros if port == node.tcpros else xmlrpc))
        if random.random() < 0.5:
            sock.settimeout(0.02)
            sock.recv(1000)


def silence(ports):
    """Connect, say nothing for a while, and close: no new peer is to connect to rospy's TCPROS port meanwhile."""
    with contextlib.ExitStack() as stack:
        for port in ports:
            stack.enter_context(socket.create_connection(port, 5))
        time.sleep(0.1)


def new_peers():
    """Somebody who connects now gets messages, also from a script that is started now."""
    for topic in ('/odom', '/odom_combined'):
        rospy.wait_for_message(topic, rospy.AnyMsg, support.LIMIT)
