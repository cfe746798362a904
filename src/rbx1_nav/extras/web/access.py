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

from rbx1_nav.extras.web.page_messages import InviteRequest, Request, StopRequest

LOCALHOST = 'localhost'
TOKEN_BYTES = 16
# environment variables with the token and the code, if another process makes and prints them
TOKEN_VARIABLE, CODE_VARIABLE = 'RBX1_NAV_TOKEN', 'RBX1_NAV_CODE'
TEACHER_VARIABLE = 'RBX1_NAV_TEACHER_PORT'      # of the teacher's page on this machine, which may connect to a seat


class Access:
    """Who may move the robot: whoever has the token. A printed address contains a code, which a browser exchanges once
    for the token, because logs and histories of browsers keep addresses."""

    def __init__(self, token: str, code: str = '') -> None:
        """code: '' for none, until invite()."""
        self.token = token
        self.codes = {code} - {''}

    def check(self, token: str, code: str) -> tuple[str, str]:
        """Return the token, or '' if neither token nor code is valid; and which was rejected: token, code or ''. A code
        is valid once."""
        if same_token(self.token, token):
            return self.token, ''
        found = next((each for each in self.codes if same_token(each, code)), '')
        self.codes.discard(found)
        return (self.token, '') if found else ('', 'code' if code else 'token' if token else '')

    def invite(self) -> str:
        """Return a new code, for another browser."""
        code = make_token()
        self.codes.add(code)
        return code


def without_token(message: Request | InviteRequest, stop_needs_token: bool) -> str:
    """Return why a request of a browser without the token is rejected, or ''. Without it, a browser may only stop."""
    if not isinstance(message, StopRequest):
        return 'this page cannot drive the robot'
    return 'Stop needs the token here, and this page has none' if stop_needs_token else ''


def make_token() -> str:
    """Return a new token or code that cannot be guessed."""
    return secrets.token_urlsafe(TOKEN_BYTES)


def page_address(address: str, port: int, code: str = '') -> str:
    """Return the address to open. A browser does not send the part after #, so no proxy can log the code."""
    return f"http://{LOCALHOST if is_wildcard(address) else in_url(address)}:{port}/{'#' if code else ''}{code}"


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
