"""Zenoh, and links beside it: the contract of transports with two ways to each reader."""

from __future__ import annotations

import logging
import os
from typing import TYPE_CHECKING, Any

from aionode.errors import TransportError
from aionode.transport.base import Transport
from aionode.transport.link.hub import Hub
from aionode.transport.link.meeting import Beacon, Meeting, meeting_folder
from aionode.transport.link.publishers import LinkWriter, can_link
from aionode.transport.link.services import LinkRequester, LinkServer
from aionode.transport.link.subscriptions import LinkReader, Tap, may_be_large

if TYPE_CHECKING:
    from aionode.graph import EndpointInfo, Graph, NodeInfo
    from aionode.transport.base import Announcement, Linkage, Reader, Requester, Serve, Writer
    from aionode.transport.link.hub import Neighbours

__all__ = ["LinkTransport"]

logger = logging.getLogger("aionode.transport.link")


class LinkTransport(Transport):
    """Uses links where there are some, and another transport for everything else.

    Args:
        participant: Id of the context: hexadecimal, no leading zeros.
        domain_id: The ROS domain.
        zenoh: The other transport.
        neighbours: What it knows of who is there.
    """

    def __init__(
        self, participant: str, domain_id: int, zenoh: Transport, neighbours: Neighbours
    ) -> None:
        self.zenoh = zenoh
        self.hub = Hub(participant, domain_id, neighbours)
        self._neighbours = neighbours
        self._graph: Graph | None = None

    def __repr__(self) -> str:
        return f"<LinkTransport links={len(self.hub.links)} beside {self.zenoh!r}>"

    @property
    def other_domains(self) -> frozenset[int]:
        """Domains of nodes that can be reached, but are not heard."""
        return frozenset(getattr(self.zenoh, "other_domains", ()))

    async def open(self, graph: Graph) -> None:
        """Connect; without a folder to meet in, or descriptors, over the other transport only."""
        meeting = None
        try:
            meeting = Meeting(meeting_folder(os.environ), self.hub.participant)
        except TransportError as error:
            logger.warning("%s; Zenoh is used between processes of this host as well", error)
        else:
            own = Beacon.own(self.hub.participant)
            self._neighbours.beacon = own.text()
            self._neighbours.on_beacon = lambda text, present: self._on_beacon(own, text, present)
        self.hub.open(graph, meeting)
        if self._graph is not graph:
            self._graph = graph
            graph.on_endpoint(self.hub.on_endpoint)
        try:
            await self.zenoh.open(graph)
        except BaseException:
            self.hub.close()
            raise

    def _on_beacon(self, own: Beacon, text: str, present: bool) -> None:
        beacon = Beacon.parse(text)
        if beacon is not None and own.is_near(beacon):
            self.hub.on_beacon(beacon, present)

    async def all_known(self, quiet_s: float) -> bool:
        """Wait until everybody who can be reached has said what there is."""
        return await self.zenoh.all_known(quiet_s)

    async def links(self) -> Linkage:
        """Ask everybody who can be linked, and who is."""
        return await self.zenoh.links()

    async def close(self) -> None:
        """Withdraw everything and disconnect.

        Linked processes get what waits for them as long as they read; one that reads nothing for a
        second is given up, and a warning says what was lost. The rest takes a second at most.
        """
        try:
            await self.hub.flush()
        finally:
            self.hub.close()
            self._neighbours.beacon = None
            await self.zenoh.close()

    def abandon(self) -> None:
        """Leave the links to the process that this one was forked from."""
        self.hub.abandon()
        self.zenoh.abandon()

    def create_node(self, node: NodeInfo) -> Announcement:
        """Announce a node."""
        return self.zenoh.create_node(node)

    def create_writer(self, endpoint: EndpointInfo, msg_type: type[Any]) -> Writer:
        """Announce a publisher."""
        zenoh = self.zenoh.create_writer(endpoint, msg_type)
        return LinkWriter(self.hub, endpoint, msg_type, zenoh) if can_link(endpoint) else zenoh

    def create_reader(
        self, endpoint: EndpointInfo, msg_type: type[Any], reader: Reader
    ) -> Announcement:
        """Announce a subscription."""
        if may_be_large(msg_type):
            # Shared memory is looked at through it: the first message would wait for the import.
            import numpy  # noqa: F401, ICN001
        tap = Tap(reader)
        zenoh = self.zenoh.create_reader(endpoint, msg_type, tap)
        return LinkReader(self.hub, msg_type, reader, tap, zenoh)

    def create_server(self, endpoint: EndpointInfo, srv_type: Any, serve: Serve) -> Announcement:
        """Announce a server."""
        zenoh = self.zenoh.create_server(endpoint, srv_type, serve)
        return LinkServer(self.hub, endpoint, srv_type, serve, zenoh)

    def create_requester(self, endpoint: EndpointInfo, srv_type: Any) -> Requester:
        """Announce a client."""
        zenoh = self.zenoh.create_requester(endpoint, srv_type)
        return LinkRequester(self.hub, endpoint, srv_type, zenoh)
