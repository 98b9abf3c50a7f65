"""The identity of a client, and the credentials in its first request."""

from __future__ import annotations

import ipaddress
from typing import TYPE_CHECKING, Any, Final
from urllib.parse import parse_qsl, urlencode

import msgspec

if TYPE_CHECKING:
    from collections.abc import Mapping

__all__ = ["Credentials", "Identity", "from_scope", "parsed_address", "place_of", "take_token"]

IPV6_HOST_BITS: Final = 64

TOKEN_PROTOCOL: Final = "bearer."  # noqa: S105  # what stands before one
"""The prefix of a token among the subprotocols of a WebSocket, where browsers cannot set a
header."""

FORWARDED: Final = frozenset({"forwarded", "via", "x-real-ip"})
"""Headers added by proxies, besides those that start with ``x-forwarded-``."""


class Identity(msgspec.Struct, frozen=True):
    """The identity of a client under the policy.

    Attributes:
        name: Its name, for the audit log and for refusals of other clients.
        groups: The groups that the policy assigns to it, which rules may refer to.
        address: The address it connects from.
    """

    name: str
    groups: frozenset[str] = frozenset()
    address: str = ""

    @property
    def place(self) -> str:
        """The network place it connects from; see `place_of`."""
        return place_of(self.address)


class Credentials(msgspec.Struct, frozen=True):
    """The evidence of a client's identity in its first request.

    Attributes:
        address: The address it connects from.
        token: Its token; empty without one. It is never printed.
        certificate: The common name of its TLS certificate, which the server has verified.
        origin: The origin of the page that has made the request; None if no page has.
        host: The ``Host`` header: the name under which the client knows the gateway.
        sec_fetch_site: The relation of the page to the gateway, as stated by the browser.
        scheme: ``http`` or ``https``.
        is_forwarded: Whether its headers show that a proxy has forwarded the request.
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
        """Whether the client runs on this host and is not a proxy, which may speak for anybody."""
        address = parsed_address(self.address)
        return address is not None and address.is_loopback and not self.is_forwarded


def from_scope(scope: Mapping[str, Any], token: str) -> Credentials:
    """Return the credentials in the ASGI scope of a request.

    Args:
        scope: The scope, of HTTP or of a WebSocket.
        token: The token found by `take_token`.
    """
    headers: dict[str, str] = {}
    for raw_name, raw_value in scope["headers"]:
        name, value = raw_name.decode("latin-1"), raw_value.decode("latin-1")
        # A header that occurs twice is ignored altogether.
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
    """Return the token of a request, and remove it from the scope, which servers may log.

    It may be in the header ``Authorization: Bearer TOKEN``, in a subprotocol ``bearer.TOKEN``, or
    in ``?token=``.
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


def parsed_address(text: str) -> ipaddress.IPv4Address | ipaddress.IPv6Address | None:
    """Return a parsed address, or None for a name. IPv4 mapped into IPv6 is returned as IPv4."""
    try:
        address = ipaddress.ip_address(text.partition("%")[0])
    except ValueError:
        return None
    return getattr(address, "ipv4_mapped", None) or address


def place_of(address: str) -> str:
    """Return the place of an address: one host may own all addresses of an IPv6 network."""
    parsed = parsed_address(address)
    if parsed is None or parsed.version == 4:
        return str(parsed or address)
    return str(ipaddress.ip_network((parsed, IPV6_HOST_BITS), strict=False))
