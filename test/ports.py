#!/usr/bin/python3
"""Prints a TCP port for a ROS master of one's own."""
import random
import socket


def free_port():
    """A TCP port of the loopback interface that nobody uses, and that no node gets meanwhile: nodes ask for any port,
    and Linux then takes one of net.ipv4.ip_local_port_range, from 32768 on.
    """
    while True:
        port = random.randrange(20000, 32000)
        with socket.socket() as sock:
            try:
                sock.bind(('127.0.0.1', port))
            except OSError:
                continue
        return port


if __name__ == '__main__':
    print(free_port())
