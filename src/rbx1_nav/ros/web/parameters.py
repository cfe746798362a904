"""The parameters of the web view."""
from __future__ import annotations

import ipaddress
import re

from rbx1_nav.config import ConfigError, YamlValue, show
from rbx1_nav.parameters import custom, flag, number

LOCALHOST = 'localhost'
MAX_TITLE = 60


def check_address(value: YamlValue) -> str:
    """Return the value of ~address: localhost, an IP address, or a host name of this machine. Raises ConfigError."""
    if isinstance(value, str):
        try:
            return str(ipaddress.ip_address(value))
        except ValueError:
            # a name that consists only of digits and dots is a mistyped IP address
            name = re.fullmatch(r'[A-Za-z0-9]([A-Za-z0-9.-]{0,251}[A-Za-z0-9])?', value)
            if name and not re.fullmatch(r'[\d.]+', value):
                return value.lower()
    raise ConfigError(f'address: {show(value)}: expected localhost, or an IP address or host name of this machine')


def check_port(value: YamlValue) -> int:
    """Return the value of ~port. Raises ConfigError."""
    if isinstance(value, int) and not isinstance(value, bool) and (value == 0 or 1024 <= value <= 65535):
        return value
    raise ConfigError(f'port: {show(value)}: expected a TCP port from 1024 to 65535, or 0 for any free port')


def check_title(value: YamlValue) -> str:
    """Return the value of ~title. Raises ConfigError."""
    if isinstance(value, str) and 0 < len(value) <= MAX_TITLE:
        return value
    raise ConfigError(f'title: {show(value)}: expected a text of 1 to {MAX_TITLE} characters')


PARAMETERS = (
    custom('address', LOCALHOST, 'address at which the page is served; localhost: for this machine only', check_address,
           note='0.0.0.0: all addresses of this machine; see [Security](web_view.md#security)'),
    custom('port', 8080, 'TCP port at which the page is served; 0: any free port', check_port,
           range='0, 1024 to 65535'),
    number('robots', 0, '', 'number of robots of a fleet: robot1, robot2 and so on; 0: the robot in the namespace of '
           'this node', 0, 20, 'a number'),
    number('spacing', 1.0, 'm', 'distance between the starts of neighbors in a fleet', 0, 1000, 'a distance'),
    custom('title', 'Out and back', 'title of the page', check_title),
    flag('stop_needs_token', False, 'whether Stop needs the token, for a machine that is shared with strangers'),
    number('linear_speed', 0.2, 'm/s', 'speed while an arrow key drives forward or backward', 0.01, 1),
    number('angular_speed', 1.0, 'rad/s', 'speed while an arrow key turns the robot', 0.01, 4))
