#!/usr/bin/python3
"""Prints a free TCP port for a private ROS master."""
import random
import socket


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


if __name__ == '__main__':
    print(free_port())
