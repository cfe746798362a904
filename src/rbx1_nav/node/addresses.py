"""Checks the addresses in the environment before a node waits: with a wrong one, it would wait for a cause it cannot
see."""
from __future__ import annotations

import os
import socket
import sys
from urllib.parse import urlsplit

import rosgraph
from rosgraph import network
import rospy

TIMEOUT = 2.0       # s to connect to this computer
UNSPECIFIED = '0.0.0.0', '::'       # a server listens at these; a connection to them reaches the own computer


def check_master_uri() -> None:
    """Print one line and exit with status 2 if ROS_MASTER_URI is no address of a master."""
    uri = rosgraph.get_master_uri()
    try:
        parts = urlsplit(uri)
        valid = parts.scheme == 'http' and parts.hostname and parts.port
    except ValueError:      # the port
        valid = False
    if not valid:
        print(f'{os.path.basename(sys.argv[0])}: error: ROS_MASTER_URI: {uri!r}: expected http://HOST:PORT, such as '
              'http://localhost:11311', file=sys.stderr)
        sys.exit(2)


def check_own_address(name: str) -> None:
    """Check that other nodes can reach this one, as roslaunch does: connect to a port of this computer. name: of
    the node. Raises ROSException."""
    host = network.get_host_name()
    variable = next((each for each in (rosgraph.ROS_HOSTNAME, rosgraph.ROS_IP) if os.environ.get(each)), 'host name')
    with socket.socket(socket.AF_INET6 if network.use_ipv6() else socket.AF_INET) as server:
        server.bind(('', 0))
        server.listen()
        try:
            if host in UNSPECIFIED:
                raise OSError('only this computer can use it')
            socket.create_connection((host, server.getsockname()[1]), TIMEOUT).close()
        except OSError as error:
            rospy.core.configure_logging(name)      # as init_node() would, so that the line has the usual format
            raise rospy.ROSException(f'{variable}: {host}: expected an address at which this computer can be reached '
                                     f'({error})') from None
