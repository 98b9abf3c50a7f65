"""Checks requests of browsers: pages of other origins and unknown host names are refused."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, Final

from aionode.errors import RefusedError
from aionode.gateway.policy.identity import parsed_address

if TYPE_CHECKING:
    from collections.abc import Iterable

    from aionode.gateway.policy.identity import Credentials

__all__ = ["check_browser", "check_host"]

HOST: Final = re.compile(r"(\[[0-9A-Fa-f:.]+(?:%\w+)?\]|[\w.-]+)(?::[0-9]{1,5})?", re.ASCII)
"""A ``Host`` header: an address or a name, optionally with a port, and never with an ``@``."""

SAME_SITES: Final = frozenset({"", "none", "same-origin"})
"""The values of Sec-Fetch-Site in a request that no page of another origin has made."""


def check_browser(
    credentials: Credentials, hosts: Iterable[str] = (), origins: Iterable[str] = ()
) -> None:
    """Refuse a request made by a page of another origin.

    A page on the Internet can make its reader's browser connect to a port of the reader's own
    machine or network, even under the page's own name if its name server resolves it so (DNS
    rebinding). So the gateway is known only by addresses, by ``localhost``, and by the names that
    the policy lists.

    Args:
        credentials: The credentials of the request.
        hosts: The names of this machine listed in the policy.
        origins: The origins of pages that may connect, listed in the policy.

    Raises:
        RefusedError: such a page made the request, or it names another host.
    """
    check_host(credentials, hosts)
    if credentials.origin is None:
        if credentials.sec_fetch_site not in SAME_SITES:
            raise RefusedError(
                "request of a page",
                "a page of another site made it; list its origin under `origins` in the policy",
                "unauthorized",
            )
    elif not is_same_origin(credentials) and credentials.origin not in set(origins):
        raise RefusedError(
            f"request of a page of {credentials.origin[:80]!r}",
            "pages of other origins may not connect; list the origin under `origins` in the policy",
            "unauthorized",
        )


def check_host(credentials: Credentials, hosts: Iterable[str] = ()) -> None:
    """Refuse a request for a host other than this one.

    Raises:
        RefusedError: this machine is not known by that name.
    """
    if not is_known_host(credentials.host, hosts):
        raise RefusedError(
            f"request for {credentials.host[:80]!r}",
            "this machine is not known by that name; use its address, or list the name under "
            "`hosts` in the policy",
            "unauthorized",
        )


def is_same_origin(credentials: Credentials) -> bool:
    """Return whether the gateway itself served the page; an opaque origin is ``null``."""
    return credentials.origin == f"{credentials.scheme}://{credentials.host}"


def is_known_host(host: str, names: Iterable[str]) -> bool:
    """Return whether a ``Host`` header names this machine, under a name that no page can rebind."""
    parts = HOST.fullmatch(host)
    if parts is None:
        return False
    name = parts[1].strip("[]").lower()
    is_local = name == "localhost" or name.endswith(".localhost")
    return is_local or parsed_address(name) is not None or name in map(str.lower, names)
