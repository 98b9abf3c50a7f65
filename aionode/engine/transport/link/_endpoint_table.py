"""The endpoints of one kind in a context that may use links, found by gid or by name."""

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
    """Endpoints, added when they are created and removed when they are closed."""

    def __init__(self) -> None:
        self._by_gid: dict[bytes, EndpointT] = {}
        self._by_name: dict[str, dict[bytes, EndpointT]] = defaultdict(dict)

    def add(self, gid: bytes, endpoint: EndpointT) -> None:
        """Add an endpoint, with its gid as other processes know it."""
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
        """Return all of them."""
        return list(self._by_gid.values())

    def named(self, name: str) -> list[EndpointT]:
        """Return those of one topic or service."""
        return list(self._by_name.get(name, {}).values())


def can_link(publisher: EndpointInfo) -> bool:
    """Whether a publisher's messages may go over a link.

    Not those of a transient-local publisher: Zenoh keeps them for late subscriptions, and therefore
    has to carry them all.
    """
    return publisher.qos.resolved().durability is not DurabilityPolicy.TRANSIENT_LOCAL


def communicate_by_link(ours: EndpointInfo, theirs: EndpointInfo) -> bool:
    """Whether two endpoints match, and the publisher, if one is, can send over a link."""
    if not ours.matches(theirs):
        return False
    publisher = ours if ours.kind is EndpointKind.PUBLISHER else theirs
    return publisher.kind is not EndpointKind.PUBLISHER or can_link(publisher)
