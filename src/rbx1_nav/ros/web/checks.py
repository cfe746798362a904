"""Checks of who may connect: address and port, the Host and Origin headers of a request, the token, the message rate.

A page from another site can send requests to this server, but the browser adds the Origin of that site. If the host
name of that site resolves to 127.0.0.1 (DNS rebinding), Origin and Host match, but the Host is the foreign name.
Rebinding needs a host name, so any IP address is accepted if the server listens on all addresses.
"""
from __future__ import annotations

import hmac
import ipaddress
import re
import secrets
import socket
from typing import Iterable
from urllib.parse import urlsplit

from rbx1_nav.config import ConfigError, YamlValue, show

LOCALHOST = 'localhost'
LOOPBACK = frozenset((LOCALHOST, '127.0.0.1', '::1'))
TOKEN_BYTES = 16
TOKEN_VARIABLE = 'RBX1_NAV_TOKEN'   # environment variable with the token, if several processes must agree on it


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


def make_token() -> str:
    """Return a new token that cannot be guessed."""
    return secrets.token_urlsafe(TOKEN_BYTES)


def page_address(address: str, port: int, token: str) -> str:
    """Return the address to open. A browser does not send the part after #, so no proxy can log the token."""
    host = LOCALHOST if is_wildcard(address) else f'[{address}]' if ':' in address else address
    return f'http://{host}:{port}/#{token}'


def same_token(token: str, given: object) -> bool:
    """Return whether the given token is correct. The time does not depend on where a wrong token differs."""
    return isinstance(given, str) and hmac.compare_digest(token.encode(), given.encode(errors='replace'))


def split_host(header: str) -> str | None:
    """Return the host in a Host header, in lower case and without the port, or None if the header is invalid."""
    try:
        parts = urlsplit(f'//{header}')
        parts.port      # raises ValueError if the port is not a number
    except ValueError:
        return None
    if parts.netloc != header or '@' in header or parts.path or parts.query or parts.fragment:
        return None
    return parts.hostname


class HostCheck:
    """Checks the Host and Origin headers of requests."""

    def __init__(self, address: str, names: Iterable[str] = ()) -> None:
        """address: where the server listens; names: host names of this machine, accepted if address is a wildcard."""
        self.any_address = is_wildcard(address)
        self.hosts = LOOPBACK | {address} | (frozenset(names) if self.any_address else frozenset())

    def accepts(self, host: str | None, origin: str | None) -> bool:
        """Return whether to answer a request with these headers; None stands for a missing header.

        A missing Origin is accepted, because a browser omits it only where it is not needed.
        """
        name = split_host(host) if host else None
        if name is None or not (name in self.hosts or self.any_address and is_address(name)):
            return False
        return origin is None or origin.lower() in (f'http://{host}'.lower(), f'https://{host}'.lower())


def is_address(name: str) -> bool:
    """Return whether a name is an IP address."""
    try:
        ipaddress.ip_address(name)
    except ValueError:
        return False
    return True


def is_wildcard(address: str) -> bool:
    """Return whether an address stands for all addresses of this machine: 0.0.0.0 or ::."""
    return is_address(address) and ipaddress.ip_address(address).is_unspecified


def machine_names() -> set[str]:
    """Return the host names that other machines may use for this machine."""
    name = socket.gethostname().lower()
    return {name, f"{name.partition('.')[0]}.local"}


class RateLimit:
    """Limits the rate of messages, but allows short bursts (a token bucket)."""

    def __init__(self, rate: float, burst: float) -> None:
        """rate: messages per second; burst: size of a burst, in messages."""
        self.rate, self.burst = rate, burst
        self.room = burst
        self.last: float | None = None

    def allows(self, now: float) -> bool:
        """Return whether another message is allowed at the time `now` (s, monotonic clock)."""
        if self.last is not None:
            self.room = min(self.burst, self.room + (now - self.last) * self.rate)
        self.last = now
        if self.room < 1:
            return False
        self.room -= 1
        return True
