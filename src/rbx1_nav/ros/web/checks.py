"""Who may connect: the Host and Origin headers of a request, the token, and the rate of messages.

A foreign page in the same browser can send requests to this server, but not with the server's own Origin. If the page's
host name is made to lead to 127.0.0.1 (DNS rebinding), Origin and Host agree, but the Host is that foreign name. An IP
address cannot be rebound, so any of them is accepted where the server listens on all addresses.
"""
from __future__ import annotations

import hmac
import ipaddress
import secrets
import socket
from typing import Iterable
from urllib.parse import urlsplit

from rbx1_nav.ros.web.parameters import LOCALHOST

LOOPBACK = frozenset((LOCALHOST, '127.0.0.1', '::1'))
TOKEN_BYTES = 16


def make_token() -> str:
    """Return a new token that cannot be guessed."""
    return secrets.token_urlsafe(TOKEN_BYTES)


def same_token(token: str, given: object) -> bool:
    """Whether a browser has given the token. Takes equally long for each wrong one."""
    return isinstance(given, str) and hmac.compare_digest(token.encode(), given.encode(errors='replace'))


def split_host(header: str) -> str | None:
    """The host in a Host header, in lower case, without its port; None if it is not a valid host."""
    try:
        parts = urlsplit(f'//{header}')
        parts.port      # raises ValueError for one that is no number
    except ValueError:
        return None
    if parts.netloc != header or '@' in header or parts.path or parts.query or parts.fragment:
        return None
    return parts.hostname


class HostCheck:
    """Which Host and Origin headers are accepted."""

    def __init__(self, address: str, names: Iterable[str] = ()) -> None:
        """address: the one that the server listens at; names: of this machine, accepted if that is a wildcard."""
        self.any_address = is_wildcard(address)
        self.hosts = LOOPBACK | {address} | (frozenset(names) if self.any_address else frozenset())

    def accepts(self, host: str | None, origin: str | None) -> bool:
        """Whether to answer a request with these headers, None for one that is missing.

        Only a program that is not a browser leaves out the Origin where it matters.
        """
        name = split_host(host) if host else None
        if name is None or not (name in self.hosts or self.any_address and is_address(name)):
            return False
        return origin is None or origin.lower() in (f'http://{host}'.lower(), f'https://{host}'.lower())


def is_address(name: str) -> bool:
    """Whether a name is an IP address."""
    try:
        ipaddress.ip_address(name)
    except ValueError:
        return False
    return True


def is_wildcard(address: str) -> bool:
    """Whether an address stands for all addresses of the machine."""
    return is_address(address) and ipaddress.ip_address(address).is_unspecified


def machine_names() -> set[str]:
    """The names by which other machines may know this one."""
    name = socket.gethostname().lower()
    return {name, f"{name.partition('.')[0]}.local"}


class RateLimit:
    """Allows a number of messages at once, and so many per second in the long run (a token bucket)."""

    def __init__(self, rate: float, burst: float) -> None:
        """rate: messages per second; burst: messages at once."""
        self.rate, self.burst = rate, burst
        self.room = burst
        self.last: float | None = None

    def allows(self, now: float) -> bool:
        """Whether another message is allowed at `now`, s of a monotonic clock."""
        if self.last is not None:
            self.room = min(self.burst, self.room + (now - self.last) * self.rate)
        self.last = now
        if self.room < 1:
            return False
        self.room -= 1
        return True
