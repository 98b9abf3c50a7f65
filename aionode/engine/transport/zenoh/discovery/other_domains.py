"""Finds other domains: on this machine, and wherever a router connects them."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

from aionode.engine.transport.network import domain_of_port
from aionode.engine.transport.zenoh.session.local_sessions import groups
from aionode.engine.wire._liveliness import PREFIX, parse_token
from aionode.graph import EndpointInfo, NodeInfo
from aionode.names import is_hidden

if TYPE_CHECKING:
    import zenoh

    from aionode.engine.transport.network import Network

__all__ = ["other_domains"]

ANSWER_S: Final = 1.0
"""Timeout for the tokens of connected sessions, in seconds; they take milliseconds."""

MAX_DOMAINS: Final = 100
"""Maximum number of domains to return."""


def other_domains(session: zenoh.Session, network: Network) -> frozenset[int]:
    """Return the other domains that have processes on this machine or nodes within reach.

    Processes of different domains are not connected, so those on this machine are found in its list
    of sessions. Routers, and settings with which domains meet, bring nodes of other domains within
    reach; hidden nodes, such as the daemon of ``ros2``, do not count. Blocks for up to a second.

    Returns:
        A hundred domain ids at most.

    Raises:
        zenoh.ZError: The session was closed meanwhile.
    """
    found = {domain for domain in map(domain_of_port, groups()) if domain is not None}
    for reply in session.liveliness().get(f"{PREFIX}/*/*/*/*/NN/**", timeout=ANSWER_S):
        token = parse_token(str(reply.ok.key_expr)) if reply.ok is not None else None
        if token is not None and is_missed(token.info):
            found.add(token.domain_id)
        if len(found) > MAX_DOMAINS:
            break
    return frozenset(sorted(found - {network.domain_id})[:MAX_DOMAINS])


def is_missed(info: NodeInfo | EndpointInfo) -> bool:
    """Return whether a token belongs to a node that somebody may be looking for."""
    return isinstance(info, NodeInfo) and not is_hidden(info.fully_qualified_name)
