#!/usr/bin/python3
"""Prints a free TCP port for a private ROS master. own_loopback() keeps tests that run side by side apart."""
import ctypes
import fcntl
import random
import socket
import struct

CLONE_NEWNET = 0x40000000       # unshare(2)
SIOCSIFFLAGS, IFF_UP = 0x8914, 1        # netdevice(7)


def free_port():
    """A free TCP port of the loopback interface that no node gets in the meantime: nodes request any port, and Linux
    then chooses one from net.ipv4.ip_local_port_range, which starts at 32768.
    """
    while True:
        port = random.randrange(20000, 32000)
        with socket.socket() as sock:
            try:
                sock.bind(('127.0.0.1', port))
            except OSError:
                continue
        return port


def own_loopback():
    """Give this thread and its children a network namespace with a loopback interface, if the system allows it.

    A killed node stays registered, and its port can be given to a node of another test. The master of the first test
    would then shut down the other node, or wait for an answer from a port that does not speak HTTP.
    """
    if ctypes.CDLL(None).unshare(CLONE_NEWNET) == 0:
        with socket.socket() as sock:
            fcntl.ioctl(sock, SIOCSIFFLAGS, struct.pack('16sH14x', b'lo', IFF_UP))


if __name__ == '__main__':
    print(free_port())
