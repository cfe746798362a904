"""A subscriber that connects as rospy does, and then hardly reads."""
import socket
import struct
import threading
from xmlrpc.client import ServerProxy
from xmlrpc.server import SimpleXMLRPCServer

import rosgraph
from geometry_msgs.msg import Twist

SMALLEST_SEGMENT = 88   # bytes: Linux accepts no less. The sender's buffer then holds about a second of commands


class SlowSubscriber:
    """Registers with the master, answers what other nodes ask, and connects to the publishers of a topic."""

    def __init__(self, name, topic, reads):
        """reads: whether it reads a byte a second; otherwise it never reads."""
        self.name = name
        self.topic = topic
        self.reads = reads
        self.sockets = []
        self.done = threading.Event()
        self.server = SimpleXMLRPCServer(('127.0.0.1', 0), logRequests=False, allow_none=True)
        self.uri = 'http://127.0.0.1:%d/' % self.server.server_address[1]
        self.server.register_function(lambda caller, topic, uris: self.connect_all(uris), 'publisherUpdate')
        self.server.register_function(lambda caller: (1, '', 1), 'getPid')
        threading.Thread(target=self.server.serve_forever, daemon=True).start()
        self.master = rosgraph.Master(name)
        self.connect_all(self.master.registerSubscriber(topic, Twist._type, self.uri))

    def connect_all(self, uris):
        """Connect to publishers, in a thread: the caller waits."""
        for uri in uris:
            threading.Thread(target=self.connect, args=(uri,), daemon=True).start()
        return 1, '', 0

    def connect(self, uri):
        """Connect to a publisher, read its header, and from then on as little as was said."""
        with ServerProxy(uri) as publisher:
            _, host, port = publisher.requestTopic(self.name, self.topic, [['TCPROS']])[2]
        sock = socket.socket()
        sock.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 1)     # the kernel takes its minimum
        sock.setsockopt(socket.IPPROTO_TCP, socket.TCP_MAXSEG, SMALLEST_SEGMENT)
        sock.connect((host, port))
        fields = dict(callerid=self.name, topic=self.topic, type=Twist._type, md5sum=Twist._md5sum, tcp_nodelay='1')
        encoded = [('%s=%s' % item).encode() for item in fields.items()]
        header = b''.join(struct.pack('<I', len(field)) + field for field in encoded)
        sock.sendall(struct.pack('<I', len(header)) + header)
        sock.recv(4, socket.MSG_WAITALL)
        self.sockets.append(sock)
        while self.reads and not self.done.wait(1):
            sock.recv(1)

    def close(self):
        """Disconnect and unregister."""
        self.done.set()
        self.master.unregisterSubscriber(self.topic, self.uri)
        for sock in self.sockets:
            sock.close()
        self.server.shutdown()
        self.server.server_close()
