"""A context's endpoints of one kind that may use links, by gid and by name."""

from __future__ import annotations

from collections import defaultdict
from typing import TYPE_CHECKING, Generic, Protocol, TypeVar

from aionode.graph import EndpointKind
from aionode.qos import DurabilityPolicy

if TYPE_CHECKING:
    from aionode.graph import EndpointInfo

__all__ = ["EndpointTable", "can_link", "communicate_by_link"]


class HasEndpoint(Protocol):
    """The counterpart of an endpoint in this transport."""

    endpoint: EndpointInfo


EndpointT = TypeVar("EndpointT", bound=HasEndpoint)


class EndpointTable(Generic[EndpointT]):
    """Endpoints, from their creation until they are closed."""

    def __init__(self) -> None:
        self._by_gid: dict[bytes, EndpointT] = {}
        self._by_name: dict[str, dict[bytes, EndpointT]] = defaultdict(dict)

    def add(self, gid: bytes, endpoint: EndpointT) -> None:
        """Add an endpoint, with the gid by which other processes know it."""
        self._by_gid[gid] = endpoint
        self._by_name[endpoint.endpoint.name][gid] = endpoint

    def remove(self, gid: bytes) -> None:
        """Remove the endpoint with this gid, if there is one."""
        endpoint = self._by_gid.pop(gid, None)
        if endpoint is not None:
            name = endpoint.endpoint.name
            del self._by_name[name][gid]
            if not self._by_name[name]:
                del self._by_name[name]

    def get(self, gid: bytes) -> EndpointT | None:
        """Return the endpoint with this gid; None if there is none."""
        return self._by_gid.get(gid)

    def values(self) -> list[EndpointT]:
        """Return all endpoints."""
        return list(self._by_gid.values())

    def named(self, name: str) -> list[EndpointT]:
        """Return the endpoints of one topic or service."""
        return list(self._by_name.get(name, {}).values())


def can_link(publisher: EndpointInfo) -> bool:
    """Return whether a publisher's messages may go over a link.

    Those of a transient-local publisher may not: Zenoh keeps them for late subscriptions, and so
    has to carry all of them.
    """
    return publisher.qos.resolved().durability is not DurabilityPolicy.TRANSIENT_LOCAL


def communicate_by_link(ours: EndpointInfo, theirs: EndpointInfo) -> bool:
    """Return whether two endpoints match, and the publisher, if any, can send over a link."""
    if not ours.matches(theirs):
        return False
    publisher = ours if ours.kind is EndpointKind.PUBLISHER else theirs
    return publisher.kind is not EndpointKind.PUBLISHER or can_link(publisher)
