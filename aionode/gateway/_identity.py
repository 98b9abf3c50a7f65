"""The identity of a client by its first request, and whether a page of another origin sent that."""

from __future__ import annotations

import ipaddress
import re
from collections.abc import Iterable, Mapping
from typing import Any, Final
from urllib.parse import parse_qsl, urlencode

import msgspec

from aionode.errors import RefusedError

__all__ = ["Credentials", "Identity", "check_browser", "from_scope", "take_token"]

TOKEN_PROTOCOL: Final = "bearer."  # noqa: S105  # what stands before one
"""Before the token, among the subprotocols of a WebSocket: browsers can set no header there."""

FORWARDED: Final = frozenset({"forwarded", "via", "x-real-ip"})
"""Headers that proxies add, beside those that begin with ``x-forwarded-``."""

HOST: Final = re.compile(r"(\[[0-9A-Fa-f:.]+(?:%\w+)?\]|[\w.-]+)(?::[0-9]{1,5})?", re.ASCII)
"""A ``Host`` header: an address or a name, and perhaps a port; nobody is named before an ``@``."""

SAME_SITES: Final = frozenset({"", "none", "same-origin"})
"""The values of Sec-Fetch-Site of a request that no page of another origin has made."""


class Identity(msgspec.Struct, frozen=True):
    """The identity of a client, by the policy.

    Attributes:
        name: For the audit log, and for others who ask who commands a topic.
        groups: The groups that the policy gives it, by which rules may name it.
        address: Where it connects from.
    """

    name: str
    groups: frozenset[str] = frozenset()
    address: str = ""


class Credentials(msgspec.Struct, frozen=True):
    """The evidence of a client's identity, in its first request.

    Attributes:
        address: Where it connects from.
        token: Its token; empty without one. It is never printed.
        certificate: The common name of its TLS certificate, which the server has verified.
        origin: The origin of the page that has made the request; None if no page has.
        host: The ``Host`` header: by which name the client knows the gateway.
        sec_fetch_site: How the page and the gateway are related, as the browser says.
        scheme: ``http`` or ``https``.
        is_forwarded: Whether a proxy has passed the request on, as its headers say.
    """

    address: str
    token: str = ""
    certificate: str = ""
    origin: str | None = None
    host: str = ""
    sec_fetch_site: str = ""
    scheme: str = "http"
    is_forwarded: bool = False

    def __repr__(self) -> str:
        secret = "token=…, " if self.token else ""
        return f"Credentials({secret}address={self.address!r}, origin={self.origin!r})"

    @property
    def is_loopback(self) -> bool:
        """Whether the client runs on this host: a proxy there may speak for anybody."""
        address = parsed_address(self.address)
        return address is not None and address.is_loopback and not self.is_forwarded


def from_scope(scope: Mapping[str, Any], token: str) -> Credentials:
    """Return the credentials in the ASGI scope of a request.

    Args:
        scope: The scope, of HTTP or of a WebSocket.
        token: The token, as `take_token` has found it.
    """
    headers: dict[str, str] = {}
    for raw_name, raw_value in scope["headers"]:
        name, value = raw_name.decode("latin-1"), raw_value.decode("latin-1")
        # Of a header that comes twice neither counts: together they fit nothing.
        headers[name] = f"{headers[name]}, {value}" if name in headers else value
    client = scope.get("client")
    return Credentials(
        address=client[0] if client else "",
        token=token,
        certificate=scope.get("state", {}).get("aionode_certificate", ""),
        origin=headers.get("origin"),
        host=headers.get("host", ""),
        sec_fetch_site=headers.get("sec-fetch-site", ""),
        scheme={"ws": "http", "wss": "https"}.get(scope["scheme"], scope["scheme"]),
        is_forwarded=any(name in FORWARDED or name.startswith("x-forwarded-") for name in headers),
    )


def take_token(scope: Mapping[str, Any]) -> str:
    """Return the token of a request, and remove it from the scope, which servers log.

    It is the header ``Authorization: Bearer TOKEN``, a subprotocol ``bearer.TOKEN``, or
    ``?token=``.
    """
    token = ""
    query = parse_qsl(scope["query_string"].decode("latin-1"), keep_blank_values=True)
    if any(name == "token" for name, _ in query):
        token = next(value for name, value in query if name == "token")
        kept = urlencode([pair for pair in query if pair[0] != "token"])
        scope["query_string"] = kept.encode()  # type: ignore[index]  # the server's own dict
    protocols = scope.get("subprotocols", [])
    for protocol in [text for text in protocols if text.startswith(TOKEN_PROTOCOL)]:
        token = protocol.removeprefix(TOKEN_PROTOCOL)
        protocols.remove(protocol)
    for name, value in scope["headers"]:
        if name == b"authorization" and value[:7].lower() == b"bearer ":
            token = value[7:].decode("latin-1").strip()
    return token


def check_browser(
    credentials: Credentials, hosts: Iterable[str] = (), origins: Iterable[str] = ()
) -> None:
    """Refuse a request that a page of another origin has made.

    A page on the Internet can have the browser of its reader connect to a port of the reader's own
    machine or network, and even under the page's own name, if its name server says so (DNS
    rebinding). So the gateway is known by addresses, by ``localhost``, and by the names that the
    policy lists.

    Args:
        credentials: Those of the request.
        hosts: The names of this machine, by the policy.
        origins: The origins of pages that may connect, by the policy.

    Raises:
        RefusedError: such a page has made it, or the request names another host.
    """
    if not is_known_host(credentials.host, hosts):
        raise RefusedError(
            f"request for {credentials.host[:80]!r}",
            "this machine is not known by that name; use its address, or list the name under "
            "`hosts` in the policy",
            "unauthorized",
        )
    if credentials.origin is None:
        if credentials.sec_fetch_site not in SAME_SITES:
            raise RefusedError(
                "request of a page",
                "a page of another site has made it; list its origin under `origins` in the policy",
                "unauthorized",
            )
    elif not is_same_origin(credentials) and credentials.origin not in set(origins):
        raise RefusedError(
            f"request of a page of {credentials.origin[:80]!r}",
            "pages of other origins may not connect; list the origin under `origins` in the policy",
            "unauthorized",
        )


def is_same_origin(credentials: Credentials) -> bool:
    """Return whether the gateway itself has served the page; an opaque origin is ``null``."""
    return credentials.origin == f"{credentials.scheme}://{credentials.host}"


def is_known_host(host: str, names: Iterable[str]) -> bool:
    """Return whether a ``Host`` header names this machine: no page can have such a name rebound."""
    parts = HOST.fullmatch(host)
    if parts is None:
        return False
    name = parts[1].strip("[]").lower()
    is_local = name == "localhost" or name.endswith(".localhost")
    return is_local or parsed_address(name) is not None or name in map(str.lower, names)


def parsed_address(text: str) -> ipaddress.IPv4Address | ipaddress.IPv6Address | None:
    """Return an address; None for a name. IPv4 mapped into IPv6 is IPv4."""
    try:
        address = ipaddress.ip_address(text.partition("%")[0])
    except ValueError:
        return None
    return getattr(address, "ipv4_mapped", None) or address
