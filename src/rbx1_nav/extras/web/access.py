"""Checks of who may connect, and who may move the robot: the host name of a request, and the token.

A page from another site can send requests to this server, but the browser adds the Origin of that site, which tornado
compares with the Host. If the host name of that site resolves to 127.0.0.1 (DNS rebinding), Origin and Host match, but
the Host is the foreign name. Rebinding needs a host name, so any IP address is accepted if the server listens on all
addresses.
"""
from __future__ import annotations

import hmac
import re
import secrets
import socket

from rbx1_nav.extras.web.page_messages import Request, StopRequest

LOCALHOST = 'localhost'
TOKEN_BYTES = 16
TOKEN_VARIABLE = 'RBX1_NAV_TOKEN'   # environment variable with the token, if several processes must agree on it


def without_token(message: Request, stop_needs_token: bool) -> str:
    """Return why a request of a browser without the token is rejected, or ''. Without it, a browser may only stop."""
    if not isinstance(message, StopRequest):
        return 'this page can only watch: open the complete address that the web view printed, with its token'
    return 'Stop needs the token here: open the complete address that the web view printed' if stop_needs_token else ''


def make_token() -> str:
    """Return a new token that cannot be guessed."""
    return secrets.token_urlsafe(TOKEN_BYTES)


def page_address(address: str, port: int, token: str) -> str:
    """Return the address to open. A browser does not send the part after #, so no proxy can log the token."""
    return f'http://{LOCALHOST if is_wildcard(address) else in_url(address)}:{port}/#{token}'


def in_url(address: str) -> str:
    """Return an IP address or a host name as it is written in the address of a page."""
    return f'[{address}]' if ':' in address else address


def is_wildcard(address: str) -> bool:
    """Return whether an address stands for all addresses of this machine."""
    return address in ('0.0.0.0', '::')


def same_token(token: str, given: object) -> bool:
    """Return whether the given token is correct. The time does not depend on where a wrong token differs."""
    return isinstance(given, str) and hmac.compare_digest(token.encode(), given.encode(errors='replace'))


def accepted_hosts(address: str) -> str:
    """Return a regular expression for the hosts, in lower case, of requests to a server that listens at an address."""
    hosts = ['localhost', '127.0.0.1', '[::1]', in_url(address.lower())]
    if is_wildcard(address):
        name = socket.gethostname().lower()
        hosts += [name, f"{name.partition('.')[0]}.local"]
        return fr"(?:[\d.]+|\[[\da-f:]+\]|{'|'.join(map(re.escape, hosts))})$"
    return f"(?:{'|'.join(map(re.escape, hosts))})$"
